#include "engine/collision/continuous/moving_distance.hpp"

namespace tumble {

double MovingDistance::closing(const Nearest& near, double t) const {
  const auto velocity = [&](const Motion& m, const Vec3& x) {
    return Vec3(m.velocity + m.omega.cross(x - m.carrier(t).x));
  };
  return near.normal.dot(velocity(a_, near.on_a) - velocity(b_, near.on_b));
}

}  // namespace tumble
