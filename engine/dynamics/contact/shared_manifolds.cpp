#include "engine/dynamics/contact/shared_manifolds.hpp"

#include "engine/collision/convex_pairs/pair.hpp"
#include "engine/collision/mesh_pairs/patches.hpp"
#include "engine/dynamics/contact/pair_side.hpp"
#include "engine/dynamics/contact/tolerances.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <limits>

namespace tumble {
namespace {

double least_gap(const Manifold& m) {
  double least = std::numeric_limits<double>::infinity();
  for (const ManifoldPoint& p : m.used()) least = std::min(least, p.gap);
  return least;
}

bool same_surface(const Material& a, const Material& b) {
  return a.friction == b.friction && a.restitution == b.restitution &&
         a.rolling_friction == b.rolling_friction && a.torsional_friction == b.torsional_friction &&
         a.surface_velocity == b.surface_velocity;
}

/// Points projected on a plane, and the convex polygon that they span. Only one may exist per
/// thread.
class Spanned {
 public:
  /// The plane is perpendicular to the unit normal.
  explicit Spanned(const Vec3& normal) {
    const Vec3 aside = std::abs(normal.x()) < 0.6 ? Vec3(Vec3::UnitX()) : Vec3(Vec3::UnitY());
    u_ = normal.cross(aside).normalized();
    v_ = normal.cross(u_);
    points_.clear();
  }

  void add(std::span<const ManifoldPoint> points) {
    for (const ManifoldPoint& p : points) points_.push_back(flat(p.x_world));
    find_corners();
  }
  /// How far a point is outside of the polygon, seen along the normal [m].
  double beyond(const Vec3& x) const {
    const Flat p = flat(x);
    const size_t n = corners_.size();
    const auto next = [&](size_t i) { return corners_[i + 1 < n ? i + 1 : 0]; };
    bool inside = n > 2;
    for (size_t i = 0; i < n && inside; ++i) inside = cross(corners_[i], next(i), p) >= 0;
    if (inside) return 0;
    double least = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < n; ++i) least = std::min(least, distance(p, corners_[i], next(i)));
    return least;
  }

 private:
  struct Flat {
    double u = 0, v = 0;
    friend auto operator<=>(const Flat&, const Flat&) = default;
  };
  Flat flat(const Vec3& x) const { return {u_.dot(x), v_.dot(x)}; }
  /// Twice the area of a triangle, positive where p is to the left of the line from `from` to `to`.
  static double cross(const Flat& from, const Flat& to, const Flat& p) {
    return (to.u - from.u) * (p.v - from.v) - (to.v - from.v) * (p.u - from.u);
  }
  static double distance(const Flat& p, const Flat& from, const Flat& to) {
    const double du = to.u - from.u, dv = to.v - from.v, length2 = du * du + dv * dv;
    const double along = (p.u - from.u) * du + (p.v - from.v) * dv;
    const double t = length2 > 0 ? std::clamp(along / length2, 0.0, 1.0) : 0;
    const double off_u = p.u - from.u - t * du, off_v = p.v - from.v - t * dv;
    return std::sqrt(off_u * off_u + off_v * off_v);
  }
  /// Convex hull by the monotone chain of Andrew (1979), counter-clockwise.
  void find_corners() {
    std::ranges::sort(points_);
    corners_.clear();
    for (int side = 0; side < 2; ++side) {
      const size_t base = corners_.size();
      for (const Flat& p : points_) {
        while (corners_.size() >= base + 2 &&
               cross(corners_[corners_.size() - 2], corners_.back(), p) <= 0)
          corners_.pop_back();
        corners_.push_back(p);
      }
      if (corners_.size() > base + 1) corners_.pop_back();  // begins the other half of the chain
      std::ranges::reverse(points_);
    }
  }

  /// Memory that is kept between uses.
  static std::vector<Flat>& memory(int which) {
    static thread_local std::array<std::vector<Flat>, 2> lists;
    return lists[size_t(which)];
  }

  Vec3 u_, v_;
  std::vector<Flat>&points_ = memory(0), &corners_ = memory(1);
};

/// Manifolds that are merged into one.
struct Group {
  Vec3 seed, sum;
  ShapesOfPair first;
  std::vector<ManifoldPoint> points;
};

class Sharing {
 public:
  Sharing(const RigidBody& a, const RigidBody& b, double margin, std::span<const uint64_t> kept)
      : a_(a), b_(b), margin_(margin), kept_(kept) {}

  void run(const ShapeManifolds& found, std::vector<Manifold>& out,
           std::vector<ShapesOfPair>& shapes) {
    static thread_local std::vector<Deep> order;
    deepest_first(found.manifolds, order);
    scale_ = tolerances::least_weight * (margin_ - order[0].gap) + tolerances::least_depth;
    for (const auto& [gap, i] : order) {
      const ShapesOfPair& at = found.shapes[i];
      if (made_of_planes(*a_.shapes[at.a].shape) && made_of_planes(*b_.shapes[at.b].shape)) {
        join(found.manifolds[i], at);
      } else {
        out.push_back(found.manifolds[i]);
        out.back().part += mark_of(at);
        shapes.push_back(at);
      }
    }
    const size_t first = out.size();
    for (size_t i = 0; i < used_; ++i) emit(groups()[i], first, out, shapes);
  }

 private:
  static std::vector<Group>& groups() {
    static thread_local std::vector<Group> memory;
    return memory;
  }
  /// A manifold by its index, with its least gap.
  struct Deep {
    double gap;
    uint32_t place;
    friend auto operator<=>(const Deep&, const Deep&) = default;
  };
  static void deepest_first(std::span<const Manifold> manifolds, std::vector<Deep>& order) {
    order.clear();
    for (uint32_t i = 0; i < manifolds.size(); ++i) order.push_back({least_gap(manifolds[i]), i});
    std::ranges::sort(order, [](const Deep& a, const Deep& b) { return a < b; });
  }

  bool alike(const ShapesOfPair& p, const ShapesOfPair& q) const {
    return (p.a == q.a || same_surface(a_.shapes[p.a].material, a_.shapes[q.a].material)) &&
           (p.b == q.b || same_surface(b_.shapes[p.b].material, b_.shapes[q.b].material));
  }

  Group& group_of(const Manifold& m, const ShapesOfPair& at) {
    size_t best = used_;
    double alignment = tolerances::shared_normal;
    for (size_t i = 0; i < used_; ++i) {
      const Group& g = groups()[i];
      const double c = g.seed.dot(m.normal);
      if (c >= alignment && alike(g.first, at)) alignment = c, best = i;
    }
    if (best < used_) return groups()[best];
    if (groups().size() == used_) groups().emplace_back();
    Group& fresh = groups()[used_++];
    fresh.seed = m.normal;
    fresh.sum.setZero();
    fresh.first = at;
    fresh.points.clear();
    return fresh;
  }

  void join(const Manifold& m, const ShapesOfPair& at) {
    Group& group = group_of(m, at);
    group.first = std::min(group.first, at);
    for (const ManifoldPoint& p : m.used()) {
      group.sum += (margin_ - p.gap + scale_) * m.normal;
      group.points.push_back(p);
    }
  }

  /// Appends a manifold of at most four of the points.
  void emit_some(std::span<const ManifoldPoint> points, const Vec3& normal, uint64_t part,
                 const ShapesOfPair& at, std::vector<Manifold>& out,
                 std::vector<ShapesOfPair>& shapes) const {
    Manifold& m = out.emplace_back();
    m.closest = {};
    reduce_points(points, normal, kept_, m);
    m.part = part;
    shapes.push_back(at);
  }

  void emit(Group& group, size_t first, std::vector<Manifold>& out,
            std::vector<ShapesOfPair>& shapes) const {
    const Vec3 normal = group.sum.normalized();
    uint64_t part = direction_cell(normal);
    for (size_t j = first; j < out.size(); ++j)
      if (out[j].part == part) part += patches_of_cell;
    std::vector<ManifoldPoint>& left = group.points;
    if (left.size() <= 4) return emit_some(left, normal, part, group.first, out, shapes);
    double extent = 0;
    for (const ManifoldPoint& p : left)
      extent = std::max(extent, (p.x_world - left[0].x_world).norm());
    Spanned spanned(normal);
    for (; !left.empty(); part += second_manifold) {
      emit_some(left, normal, part, group.first, out, shapes);
      spanned.add(out.back().used());
      std::erase_if(left, [&](const ManifoldPoint& p) {
        return spanned.beyond(p.x_world) <= tolerances::left_out_of_extent * extent;
      });
    }
  }

  const RigidBody &a_, &b_;
  double margin_;
  std::span<const uint64_t> kept_;
  double scale_ = 0;
  size_t used_ = 0;
};

}  // namespace

void share_manifolds(const RigidBody& a, const RigidBody& b, const ShapeManifolds& found,
                     double margin, std::span<const uint64_t> kept, std::vector<Manifold>& out,
                     std::vector<ShapesOfPair>& shapes) {
  if (!found.manifolds.empty()) Sharing(a, b, margin, kept).run(found, out, shapes);
}

}  // namespace tumble
