#include "engine/collision/continuous/moving_pair.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// Radius about the frame's origin of the points that rotation moves; rounding does not count [m].
double turning_radius(const Shape& s) {
  return s.bounding_radius() - (s.convex() ? s.convex()->rounding() : 0);
}

MovingCore moving_core_of(const Shape& s, const Motion& m, double lever, bool v_clip) {
  const ConvexShape& convex = *s.convex();
  return {convex, m, lever, turning_radius(s), v_clip ? convex.voronoi() : nullptr};
}

}  // namespace

double MovingPair::speed() const {
  const auto turning = [](const Motion& m, double lever) {
    const double spin = m.omega.norm();
    return spin > 0 ? spin * lever : 0;
  };
  return (motion_a.velocity - motion_b.velocity).norm() + turning(motion_a, lever_a()) +
         turning(motion_b, lever_b());
}

double MovingPair::drift(double from, double to) const {
  const double half = 0.5 * (to - from);
  const auto speed = [&](const Shape& s, const Motion& m) {
    const double by_lever = m.speed_bound(m.lever(s.bounding_radius()));
    if (!rides_far(m, s.bounding_radius())) return by_lever;
    const double orbit = m.orbit_speed(), spin = m.omega.norm();
    const double origin =
        std::min(m.velocity.norm() + orbit,
                 m.origin_velocity(from + half).norm() + 0.5 * spin * orbit * half);
    return std::min(by_lever, origin + spin * turning_radius(s));
  };
  return (speed(a, motion_a) + speed(b, motion_b)) * half;
}

MovingCore MovingPair::core_a() const {
  return moving_core_of(a, motion_a, lever_a(), options.v_clip && b.convex());
}

MovingCore MovingPair::core_b() const {
  return moving_core_of(b, motion_b, lever_b(), options.v_clip && a.convex());
}

}  // namespace tumble
