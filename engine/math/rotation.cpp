#include "engine/math/rotation.hpp"

#include "engine/math/det/det.hpp"

#include <cmath>

namespace tumble {

Mat3 skew(const Vec3& a) {
  return {0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0};
}

Quat axis_angle(const Vec3& axis, double angle) {
  const double length = axis.norm();
  if (!(length > 0)) return Quat::Identity();
  const double s = det::sin(0.5 * angle) / length;
  return Quat(det::cos(0.5 * angle), s * axis.x(), s * axis.y(), s * axis.z());
}

Quat euler_xyz(const Vec3& angles) {
  const Quat q = axis_angle(Vec3::UnitX(), angles.x()) * axis_angle(Vec3::UnitY(), angles.y()) *
                 axis_angle(Vec3::UnitZ(), angles.z());
  return q.normalized();
}

Vec3 angles_xyz(const Quat& q) {
  const Mat3 r = q.toRotationMatrix();
  const double a = det::atan2(-r(1, 2), r(2, 2)), s = det::sin(a), c = det::cos(a);
  return {a, det::atan2(r(0, 2), c * r(2, 2) - s * r(1, 2)),
          det::atan2(c * r(1, 0) + s * r(2, 0), c * r(1, 1) + s * r(2, 1))};
}

Quat integrate_rotation(const Quat& q, const Vec3& omega, double h) {
  const double speed = omega.norm();
  if (!(speed > 0)) return q;
  return (axis_angle(omega, speed * h) * q).normalized();
}

Quat interpolate(const Quat& a, const Quat& b, double s) {
  const double sign = a.dot(b) < 0 ? -1.0 : 1.0;
  Quat out(a.coeffs() * (1 - s) + b.coeffs() * (sign * s));
  const double length = out.norm();
  if (!(length > 0)) return a;
  out.coeffs() /= length;
  return out;
}

Pose interpolate(const Pose& a, const Pose& b, double s) {
  return {a.x + s * (b.x - a.x), interpolate(a.q, b.q, s)};
}

Quat rotation_between(const Vec3& a, const Vec3& b) {
  const double c = a.dot(b);
  if (c < -1 + 1e-12) {
    Vec3 t1, t2;
    tangent_frame(a, t1, t2);
    return Quat(0, t1.x(), t1.y(), t1.z());
  }
  const Vec3 v = a.cross(b);
  return Quat(1 + c, v.x(), v.y(), v.z()).normalized();
}

void tangent_frame(const Vec3& n, Vec3& t1, Vec3& t2) {
  // A right-handed orthonormal frame whose third axis points away from the one bad direction.
  static const Vec3 a = Vec3(3, -6, 2) / 7, b = Vec3(6, 2, -3) / 7, c = Vec3(2, 3, 6) / 7;
  const double x = n.dot(a), y = n.dot(b), z = n.dot(c), square = x * x + y * y;
  if (z < 0 && square < 1e-290) {
    t1 = a;
    t2 = -b;
    return;
  }
  // 1 / (1 + z), which is (1 - z) / (x^2 + y^2) on the unit sphere: each where it loses nothing.
  const double k = z >= 0 ? 1 / (1 + z) : (1 - z) / square;
  t1 = (1 - k * x * x) * a - k * x * y * b - x * c;
  t2 = -k * x * y * a + (1 - k * y * y) * b - y * c;
}

}  // namespace tumble
