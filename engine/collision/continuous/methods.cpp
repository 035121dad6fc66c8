#include "engine/collision/continuous/bisection.hpp"
#include "engine/collision/continuous/closed_forms.hpp"
#include "engine/collision/continuous/mesh_advancement.hpp"
#include "engine/collision/continuous/swept_triangles.hpp"

#include <algorithm>

namespace tumble {
namespace {

bool always(const MovingPair&) {
  return true;
}

/// Convex shapes that move no farther than their thickness: two distances decide most pairs.
bool slow(const MovingPair& p) {
  return p.speed() * (p.t1() - p.t0()) <= std::min(p.a.inner_radius(), p.b.inner_radius());
}

/// Surfaces that move no farther than a quarter of their size: the near triangles stay near.
bool stays_near(const MovingPair& p) {
  const double size = std::min(p.surface_a().size, p.surface_b().size);
  return p.speed() * (p.t1() - p.t0()) <= 0.25 * size;
}

/// An entry of the list that applies; the rules are the table of README.md.
const ContactTimeMethod& choice(const MovingPair& p) {
  const auto& all = all_contact_time_methods();
  enum { bisection = 1, advancement, triangles, balls };
  if (balls_apply(p)) return all[balls];
  if (p.half_space()) return all[advancement];
  if (p.both_convex()) return all[slow(p) ? bisection : advancement];
  if (p.a.polyhedral() && !stays_near(p)) return all[triangles];
  return all[advancement];
}

TimeOfContact find_automatically(const MovingPair& p) {
  const ContactTimeMethod& method = choice(p);
  TimeOfContact r = method.find(p);
  if (r.method.empty()) r.method = method.name;
  return r;
}

}  // namespace

const std::vector<ContactTimeMethod>& all_contact_time_methods() {
  static const std::vector<ContactTimeMethod> list{
      {"automatic", "by pair: see the table", always, find_automatically},
      {"bisection", "distances at both ends of ever shorter intervals", always, find_by_bisection},
      {"conservative_advancement", "steps of the distance over a bound on the approach", always,
       find_by_advancement},
      {"continuous_triangles", "certified tests of triangles over swept hierarchies",
       triangles_apply, find_by_triangles},
      {"sphere_sphere", "the quadratic of two balls", balls_apply, find_by_balls},
      {"box_box", "separating axes of two boxes that turn", boxes_apply, find_by_boxes},
  };
  return list;
}

}  // namespace tumble
