#include "engine/collision/time_of_contact.hpp"

#include "engine/collision/continuous/advancement.hpp"
#include "engine/collision/continuous/mesh_advancement.hpp"
#include "engine/collision/shapes/polyhedral.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// The cases with A before B in the order half-space, convex, mesh.
TimeOfContact ordered(const Shape& a, const Motion& ma, const Shape& b, const Motion& mb,
                      double tolerance) {
  const double lever_a = ma.lever(a.bounding_radius()), lever_b = mb.lever(b.bounding_radius());
  const ConvexShape *ca = a.convex(), *cb = b.convex();
  if (a.type() == ShapeType::half_space) {
    if (cb) return advance_half_space(ma, {*cb, mb, lever_b}, ma.t0, ma.t1, tolerance);
    return advance_half_space_mesh(ma, b.polyhedral()->surface(), mb, lever_b, tolerance);
  }
  if (ca && cb) return advance({*ca, ma, lever_a}, {*cb, mb, lever_b}, ma.t0, ma.t1, tolerance);
  if (ca) return advance_convex_mesh(a, ma, b.polyhedral()->surface(), mb, lever_b, tolerance);
  return advance_mesh_mesh(a.polyhedral()->surface(), ma, lever_a, b.polyhedral()->surface(), mb,
                           lever_b, tolerance);
}

int order(const Shape& s) {
  return s.type() == ShapeType::half_space ? 0 : s.convex() ? 1 : 2;
}

}  // namespace

std::string_view to_string(TimeOfContactStatus status) {
  switch (status) {
    case TimeOfContactStatus::separated:
      return "separated";
    case TimeOfContactStatus::contact:
      return "contact";
    case TimeOfContactStatus::initially_overlapping:
      return "initially_overlapping";
    case TimeOfContactStatus::max_iterations:
      return "max_iterations";
  }
  return "?";
}

TimeOfContact time_of_contact(const Shape& a, const Motion& motion_a, const Shape& b,
                              const Motion& motion_b, double tolerance) {
  TimeOfContact r;
  if (order(a) == 0 && order(b) == 0) {
    r.time = r.low = r.high = motion_a.t1;
    return r;
  }
  if (order(a) <= order(b)) return ordered(a, motion_a, b, motion_b, tolerance);
  r = ordered(b, motion_b, a, motion_a, tolerance);
  std::swap(r.on_a, r.on_b);
  std::swap(r.triangle_a, r.triangle_b);
  r.normal = -r.normal;
  return r;
}

}  // namespace tumble
