#include "engine/collision/continuous/moving_pair.hpp"

namespace tumble {
namespace {

MovingCore moving_core_of(const Shape& s, const Motion& m, double lever, bool v_clip) {
  const ConvexShape& convex = *s.convex();
  return {convex, m, lever, v_clip ? convex.voronoi() : nullptr};
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

MovingCore MovingPair::core_a() const {
  return moving_core_of(a, motion_a, lever_a(), options.v_clip && b.convex());
}

MovingCore MovingPair::core_b() const {
  return moving_core_of(b, motion_b, lever_b(), options.v_clip && a.convex());
}

}  // namespace tumble
