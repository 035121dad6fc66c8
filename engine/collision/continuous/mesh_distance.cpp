#include "engine/collision/continuous/mesh_distance.hpp"

#include "engine/collision/triangle_core.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

class ConvexMeshDistance final : public MovingDistance {
 public:
  explicit ConvexMeshDistance(const MovingPair& p)
      : MovingDistance(p.motion_a, p.motion_b),
        shape_(p.a),
        core_(p.core_a()),
        b_surface_(p.surface_b()),
        tolerance_(p.tolerance) {
    fastest_ = p.speed();
    const Vec3 centre = p.motion_a.pose(p.t0()).point(core_.core.centre());
    const auto near = b_surface_.tree->closest(p.motion_b.pose(p.t0()).inverse_point(centre),
                                               std::numeric_limits<double>::infinity());
    if (near) last_ = near->triangle;
  }
  double approach(const Vec3&) const override { return fastest_; }

  Nearest at(double t, double reach) override {
    const Pose pa = a_.pose(t), pb = b_.pose(t);
    const Pose relative = pb.inverse() * pa;
    // The nearest triangle of the last query first: the tree can then skip whatever is farther.
    Nearest best = to_triangle(last_, pa, pb, reach);
    const double within = std::min(reach, best.distance);
    triangles_.clear();
    b_surface_.tree->overlap(shape_.bounds(relative).inflated(within * (1 + 1e-9)), triangles_);
    for (const uint32_t k : triangles_) {
      if (!(best.distance > 0)) break;
      if (k == last_) continue;
      const Nearest n = to_triangle(k, pa, pb, best.distance);
      if (n.distance < best.distance) best = n;
    }
    if (best.distance > reach) best.distance = reach;
    last_ = best.triangle_b;
    return best;
  }

 private:
  Nearest to_triangle(uint32_t k, const Pose& pa, const Pose& pb, double reach) const {
    const MeshSurface& s = b_surface_;
    const TriangleCore triangle(s.mesh->corner(k, 0), s.mesh->corner(k, 1), s.mesh->corner(k, 2));
    const MovingCore other{triangle, b_, 0, 0};
    Nearest n = nearest_cores(core_, pa, other, pb, reach, tolerance_);
    n.triangle_b = k;
    return n;
  }

  const Shape& shape_;
  MovingCore core_;
  const MeshSurface& b_surface_;
  double tolerance_;
  std::vector<uint32_t> triangles_;
  uint32_t last_ = 0;
};

class MeshMeshDistance final : public MovingDistance {
 public:
  explicit MeshMeshDistance(const MovingPair& p)
      : MovingDistance(p.motion_a, p.motion_b),
        a_surface_(p.surface_a()),
        b_surface_(p.surface_b()) {
    fastest_ = p.speed();
    size_ = a_surface_.size + b_surface_.size;
  }
  double approach(const Vec3&) const override { return fastest_; }

  Nearest at(double t, double reach) override {
    const Pose pa = a_.pose(t), pb = b_.pose(t);
    Nearest n;
    n.distance = reach;
    const auto near = a_surface_.tree->distance(*b_surface_.tree, pa.inverse() * pb, reach);
    if (!near) return n;
    n.on_a = pa.point(near->on_a), n.on_b = pa.point(near->on_b);
    const double distance = std::sqrt(near->squared_distance);
    // Nearly parallel sides (within 1e-8) may hide an error of 1e-16 size^2 in the squared
    // distance.
    const double rounding = 1e-13 * size_ + (distance > 0 ? 4e-16 * size_ * size_ / distance : 0);
    n.distance = std::max(0.0, distance - rounding);
    if (distance > 0) n.normal = pa.direction(near->on_b - near->on_a) / distance;
    n.triangle_a = near->triangles.a, n.triangle_b = near->triangles.b;
    return n;
  }

 private:
  const MeshSurface &a_surface_, &b_surface_;
  double size_ = 0;  ///< of both [m]
};

}  // namespace

std::unique_ptr<MovingDistance> mesh_distance(const MovingPair& p) {
  if (p.a.convex()) return std::make_unique<ConvexMeshDistance>(p);
  return std::make_unique<MeshMeshDistance>(p);
}

}  // namespace tumble
