#include "engine/dynamics/event/core_gap.hpp"

#include "engine/collision/gjk/epa.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/dynamics/event/prices.hpp"
#include "engine/dynamics/event/tolerances.hpp"

#include <algorithm>
#include <limits>

namespace tumble {
namespace {

/// Climbs to the greatest separation near a direction, by nearest points of separated cores.
void climb(const CorePair& cores, Vec3 n, CoreContact& best) {
  best.gap = -std::numeric_limits<double>::infinity();
  for (int k = 0; k < tolerances::most_lifts; ++k) {
    const double separation = cores.separation(n);
    const Vec3 by = (std::max(0.0, -separation) + tolerances::lift_of_size * cores.size) * n;
    PlacedCore moved = cores.b;
    moved.x += by;
    charge_work(prices::nearest_points);
    const GjkResult r = gjk(cores.a, moved);
    if (r.status != GjkStatus::separated) return;
    const double found = cores.separation(r.normal);
    const double turned = (r.normal - n).norm();
    if (found > best.gap) best = {r.normal, found, r.a, r.b - by, true, found < 0};
    if (turned <= tolerances::same_direction ||
        found < separation - tolerances::separation_rounding * cores.size)
      return;
    n = r.normal;
  }
}

}  // namespace

CoreContact core_gap(const CorePair& cores, double farthest, const Vec3& towards_b) {
  GjkOptions options;
  options.max_distance = farthest;
  options.initial_direction = towards_b;
  charge_work(prices::nearest_points);
  const GjkResult near = gjk(cores.a, cores.b, options);
  CoreContact best;
  best.gap = near.distance;
  if (near.status == GjkStatus::beyond) return best;
  const bool apart = near.status != GjkStatus::intersecting;
  if (apart && near.distance > tolerances::nearest_points_of_size * cores.size)
    return {near.normal, near.distance, near.a, near.b, true, false};
  best.gap = -std::numeric_limits<double>::infinity();
  // If they touch, the last normal is a better start than the noise of touching points.
  if (!towards_b.isZero()) climb(cores, towards_b, best);
  if (!(best.gap > -tolerances::nearest_points_of_size * cores.size)) {
    const Vec3 start = apart ? near.normal : epa(cores.a, cores.b, near.simplex).normal;
    CoreContact other;
    climb(cores, start, other);
    if (other.gap > best.gap) best = other;
  }
  return best;
}

}  // namespace tumble
