#include "engine/core/stop.hpp"
#include "engine/geometry/constructions/radical_inverse.hpp"
#include "engine/geometry/constructions/surface_samples.hpp"
#include "engine/geometry/distance_field/distance_field.hpp"
#include "engine/geometry/primitive_tests/point_in_object.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {

ExactDistance exact_distance(const Hierarchy& surface, const Vec3& p) {
  ExactDistance out;
  const auto near = surface.closest(p, std::numeric_limits<double>::infinity());
  if (!near) return out;
  out.closest = near->point;
  out.triangle = near->triangle;
  const double d = std::sqrt(near->squared_distance);
  const PointSide side = point_in_object(p, surface).side;
  if (side == PointSide::boundary || d == 0) {
    out.gradient = face_normal(surface.mesh(), near->triangle);
    return out;
  }
  out.distance = side == PointSide::inside ? -d : d;
  out.gradient = (p - near->point) / out.distance;
  return out;
}

FieldError measure_field_error(const DistanceField& field, const Hierarchy& surface,
                               size_t samples) {
  FieldError out;
  const TriangleMesh& mesh = surface.mesh();
  const SurfaceSamples on_surface(mesh);
  double squares = 0;
  for (size_t n = 1; n <= samples && !stop_requested(); ++n) {
    // A point on the surface, uniform by area, is moved off it along the normal.
    const auto [on, t] = on_surface(n);
    const Vec3 p = on + (2 * radical_inverse(n, 7) - 1) * field.band() * face_normal(mesh, t);
    const double off = std::fabs(field.value(p) - exact_distance(surface, p).distance);
    squares += off * off;
    out.largest = std::max(out.largest, off);
    ++out.samples;
  }
  if (out.samples > 0) out.rms = std::sqrt(squares / double(out.samples));
  return out;
}

}  // namespace tumble
