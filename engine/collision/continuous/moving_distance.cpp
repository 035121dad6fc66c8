#include "engine/collision/continuous/moving_distance.hpp"

#include <limits>

namespace tumble {

double MovingDistance::open_for(const Vec3& n, double /*t*/, double gap) const {
  const double speed = approach(n);
  return speed > 0 ? gap / speed : std::numeric_limits<double>::infinity();
}

double MovingDistance::closing(const Nearest& near, double t) const {
  const auto velocity = [&](const Motion& m, const Vec3& x) {
    return Vec3(m.velocity + m.omega.cross(x - m.carrier(t).x));
  };
  return near.normal.dot(velocity(a_, near.on_a) - velocity(b_, near.on_b));
}

}  // namespace tumble
