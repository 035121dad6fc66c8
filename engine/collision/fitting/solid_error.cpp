#include "engine/collision/fitting/solid_error.hpp"

#include "engine/collision/query.hpp"
#include "engine/core/stop.hpp"
#include "engine/geometry/constructions/radical_inverse.hpp"
#include "engine/geometry/constructions/surface_samples.hpp"
#include "engine/geometry/primitive_tests/point_in_object.hpp"
#include "engine/math/det/det.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tumble {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

Vec3 on_unit_sphere(double u, double v) {
  const double z = 2 * u - 1, across = std::sqrt(std::max(0.0, 1 - z * z));
  const double turn = 2 * std::numbers::pi * v;
  return {across * det::cos(turn), across * det::sin(turn), z};
}

/// How far points of the shapes are from the mesh.
class Outside {
 public:
  Outside(const Hierarchy& surface, bool closed) : surface_(surface), closed_(closed) {}
  double worst() const { return worst_; }

  void offer(const Vec3& p) {
    const auto near = surface_.closest(p, unlimited);
    if (!near) return;
    const double d = std::sqrt(near->squared_distance);
    if (d <= worst_) return;
    if (closed_ && point_in_object(p, surface_).side != PointSide::outside) return;
    worst_ = d;
  }
  void offer_inside(const Vec3& p) {
    if (closed_) offer(p);
  }

 private:
  const Hierarchy& surface_;
  bool closed_;
  double worst_ = 0;
};

/// A chord between two random points of a ball about the shape is a random line, and those meet a
/// surface evenly (Santaló, "Integral Geometry and Geometric Probability", 1976, ch. 12).
void offer_line(const PlacedShape& s, size_t n, const Vec3& centre, double radius, Outside& out) {
  const Vec3 a = centre + radius * on_unit_sphere(radical_inverse(n, 2), radical_inverse(n, 3));
  const Vec3 b = centre + radius * on_unit_sphere(radical_inverse(n, 5), radical_inverse(n, 7));
  const auto in = ray_cast(*s.shape, s.pose, Ray{a, b - a}, 1);
  if (!in) return;
  const auto back = ray_cast(*s.shape, s.pose, Ray{b, a - b}, 1);
  const double first = in->t, last = back ? 1 - back->t : first;
  out.offer(a + first * (b - a));
  out.offer(a + last * (b - a));
  out.offer_inside(a + (first + radical_inverse(n, 11) * (last - first)) * (b - a));
}

/// How far a point of the mesh is outside all shapes.
double outside_all(std::span<const PlacedShape> shapes, const Vec3& p, double enough) {
  double least = unlimited;
  for (const PlacedShape& s : shapes) {
    if (const auto near = closest_point(*s.shape, s.pose, p))
      least = std::min(least, near->distance);
    if (least <= enough) break;
  }
  return std::isfinite(least) ? std::max(least, 0.0) : 0;
}

}  // namespace

SolidError solid_error(std::span<const PlacedShape> shapes, const Hierarchy& surface, bool closed,
                       size_t samples) {
  SolidError out;
  if (shapes.empty() || surface.mesh().triangles.empty()) return out;
  Outside outside(surface, closed);
  const size_t share = samples / shapes.size() + 20;
  for (const PlacedShape& s : shapes) {
    const Aabb box = s.shape->bounds(s.pose);
    for (size_t n = 1; n <= share && !stop_requested(); ++n)
      offer_line(s, n, box.centre(), 0.5 * box.extent().norm(), outside);
  }
  out.added = outside.worst();
  const SurfaceSamples on_surface(surface.mesh());
  const std::vector<Vec3>& corners = surface.mesh().vertices;
  const size_t stride = std::max<size_t>(1, corners.size() / (2 * samples));
  const auto look = [&](const Vec3& p) {
    out.missing = std::max(out.missing, outside_all(shapes, p, out.missing));
  };
  for (size_t n = 0; n < corners.size() && !stop_requested(); n += stride) look(corners[n]);
  for (size_t n = 1; n <= samples && !stop_requested(); ++n) look(on_surface(n).point);
  return out;
}

}  // namespace tumble
