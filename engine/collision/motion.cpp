#include "engine/collision/motion.hpp"

#include "engine/math/det/det.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>

namespace tumble {

Pose Motion::carrier(double t) const {
  return {start.x + (t - t0) * velocity, integrate_rotation(start.q, omega, t - t0)};
}

double Motion::speed_bound(double lever) const {
  const double spin = omega.norm();
  return velocity.norm() + (spin > 0 ? spin * lever : 0);
}

double Motion::speed_bound_along(const Vec3& n, double lever) const {
  const double spin = n.cross(omega).norm();
  return n.dot(velocity) + (spin > 0 ? spin * lever : 0);
}

Vec3 Motion::origin_velocity(double t) const {
  return velocity + omega.cross(carrier(t).direction(offset.x));
}

Motion Motion::at_rest(const Pose& pose, double t0, double t1) {
  Motion m;
  m.start = pose;
  m.t0 = t0, m.t1 = t1;
  return m;
}

Motion Motion::between(const Pose& from, const Pose& to, double t0, double t1) {
  Motion m = at_rest(from, t0, t1);
  const double h = t1 - t0;
  if (!(h > 0)) return m;
  m.velocity = (to.x - from.x) / h;
  Quat turn = to.q * from.q.conjugate();
  if (turn.w() < 0) turn.coeffs() = -turn.coeffs();
  const double sine = turn.vec().norm();
  if (sine > 0) m.omega = turn.vec() / sine * (2 * det::atan2(sine, turn.w()) / h);
  return m;
}

double arc_height(double angle, double radius) {
  if (angle == 0) return 0;                              // the radius of a half-space has no bound
  return std::min(0.125 * angle * angle, 2.0) * radius;  // 1 - cos(x) <= x^2 / 2
}

}  // namespace tumble
