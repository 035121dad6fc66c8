#include "engine/dynamics/bodies/inner_radius.hpp"

#include "engine/collision/shapes/convex_shape.hpp"
#include "engine/core/bytes.hpp"
#include "engine/core/hash.hpp"
#include "engine/dynamics/bodies/inner_ball.hpp"
#include "engine/dynamics/bodies/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <vector>

namespace tumble {
namespace {

bool meet(const InnerBall& a, const InnerBall& b) {
  return (a.centre - b.centre).norm() < a.radius + b.radius;
}

/// Directions along and across the axes of a shape: to the sides, edges and corners of a cube.
std::vector<Vec3> outward_ways() {
  std::vector<Vec3> out;
  for (int k = 0; k < 27; ++k)
    if (k != 13) out.push_back(Vec3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1).normalized());
  return out;
}

/// The balls in a body's convex shapes, and the thickness that they give.
class Thickness {
 public:
  explicit Thickness(std::span<const BodyShape> shapes) : surface_(shapes) {
    for (const BodyShape& s : shapes)
      if (s.shape->convex()) balls_.push_back(ball_about(surface_, middle_of(s)));
    middles_ = balls_.size();
  }

  /// Thickness of a shape by the balls in the middles of convex shapes; `index` is its index among
  /// these.
  double by_middles(const BodyShape& s, size_t index) const {
    double thick = std::max(s.shape->inner_radius(), balls_[index].radius);
    for (size_t k = 0; k < middles_; ++k)
      if (balls_[k].radius > thick && meet(balls_[k], balls_[index])) thick = balls_[k].radius;
    return thick;
  }

  /// The radius to which the ball in the middle of a shape grows, at most `enough`.
  double grown_middle(size_t index, double enough) {
    balls_.push_back(grown_ball(surface_, balls_[index].centre, enough));
    return std::min(balls_.back().radius, enough);
  }

  /// The least thickness of a convex shape at places outside of all balls of radius `least`;
  /// `least` if none is thinner.
  double where_bare(const BodyShape& s, double least) {
    static const std::vector<Vec3> ways = outward_ways();
    const ConvexShape& shape = *s.shape->convex();
    const double own = s.shape->inner_radius();
    for (const Vec3& d : ways) {
      if (own >= least) break;  // no shape counts less than its own radius
      const Vec3 to = s.pose.point(shape.support(d) + shape.rounding() * d), from = middle_of(s);
      const double length = (to - from).norm() - 2 * own;
      if (length > 0) least = along(from, (to - from).normalized(), length, own, least);
    }
    return least;
  }

 private:
  static Vec3 middle_of(const BodyShape& s) { return s.pose.point(s.shape->convex()->centre()); }

  /// From the far end of a line inwards, from ball to ball.
  double along(const Vec3& from, const Vec3& d, double length, double own, double least) {
    for (double t = length; t > 0;) {
      const Vec3 p = from + t * d;
      const double enter = held_from(p, d, least / tolerances::larger_ball);
      if (enter > 0) {
        t -= enter;
        continue;
      }
      const InnerBall here = ball_about(surface_, p);
      const InnerBall grown = grown_ball(surface_, p, least);
      balls_.push_back(grown);
      if (grown.radius < least) least = std::max(own, grown.radius);
      if (own >= least) break;
      t -= std::max(here.radius, own);
    }
    return least;
  }

  /// How far back along a line the balls reach that contain a point and are at least this large.
  double held_from(const Vec3& p, const Vec3& d, double radius) const {
    double out = 0;
    for (const InnerBall& b : balls_) {
      if (b.radius < radius) continue;
      const Vec3 to = p - b.centre;
      const double behind = d.dot(to), inside = b.radius * b.radius - to.squaredNorm();
      if (inside > tolerances::same_ball * b.radius * b.radius)
        out = std::max(out, behind + std::sqrt(behind * behind + inside));
    }
    return out;
  }

  BareSurface surface_;
  std::vector<InnerBall> balls_;  ///< first those in the middles of convex shapes
  size_t middles_ = 0;
};

/// A convex shape of several.
struct Part {
  const BodyShape* shape;
  size_t index;  ///< index among the convex ones
  double own, thick;
};

double found_thickness(std::span<const BodyShape> shapes) {
  Thickness thickness(shapes);
  std::vector<Part> parts;
  double least = std::numeric_limits<double>::infinity();
  for (const BodyShape& s : shapes) {
    const double own = s.shape->inner_radius();
    if (s.shape->convex())
      parts.push_back({&s, parts.size(), own, thickness.by_middles(s, parts.size())});
    else
      least = std::min(least, own);
  }
  std::ranges::stable_sort(parts, {}, &Part::thick);
  for (const Part& p : parts) {
    if (p.thick >= least) break;
    least = std::max(p.thick, thickness.grown_middle(p.index, least));
  }
  std::ranges::stable_sort(parts, {}, &Part::own);
  for (const Part& p : parts) {
    if (p.own >= least) break;
    least = thickness.where_bare(*p.shape, least);
  }
  return least;
}

/// Hash of everything that a thickness depends on.
uint64_t content_of(std::span<const BodyShape> shapes) {
  ByteWriter out;
  for (const BodyShape& s : shapes) {
    const ShapeDef& def = s.shape->def();
    out.value(def.type);
    out.value(s.pose.x);
    out.value(s.pose.q.coeffs());
    if (!s.shape->convex()) {
      out.value(s.shape->inner_radius());
      continue;
    }
    for (const ShapeParameter& p : shape_entry(def.type).parameters) {
      if (p.number) out.value(def.*p.number);
      if (p.vector) out.value(def.*p.vector);
    }
    if (!made_of_mesh(def.type)) continue;
    out.value(uint64_t(def.mesh->vertices.size()));
    out.raw(def.mesh->vertices.data(), def.mesh->vertices.size() * sizeof(Vec3));
  }
  return hash_bytes(out.bytes());
}

}  // namespace

double inner_radius_of(std::span<const BodyShape> shapes) {
  if (shapes.empty()) return 0;
  if (shapes.size() == 1) return shapes[0].shape->inner_radius();
  static std::mutex mutex;
  static std::map<uint64_t, double> known;
  const uint64_t content = content_of(shapes);
  {
    const std::scoped_lock lock(mutex);
    if (const auto it = known.find(content); it != known.end()) return it->second;
  }
  const double found = found_thickness(shapes);
  const std::scoped_lock lock(mutex);
  if (known.size() >= tolerances::remembered_thicknesses) known.clear();
  known.emplace(content, found);
  return found;
}

}  // namespace tumble
