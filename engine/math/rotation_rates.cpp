#include "engine/math/rotation_rates.hpp"

#include "engine/math/rotation.hpp"

namespace tumble {

namespace {

/// (0, v) q
Quat vector_times(const Vec3& v, const Quat& q) {
  const Vec3 u = q.vec();
  const Vec3 out = q.w() * v + v.cross(u);
  return Quat(-v.dot(u), out.x(), out.y(), out.z());
}

}  // namespace

Vec3 attached_rate(const Vec3& r, const Vec3& omega) {
  return omega.cross(r);
}

Vec3 attached_second_rate(const Vec3& r, const Vec3& omega, const Vec3& alpha) {
  return alpha.cross(r) + omega.cross(omega.cross(r));
}

Vec3 carried_rate(const Vec3& r, const Vec3& relative_rate, const Vec3& omega) {
  return relative_rate + omega.cross(r);
}

Vec3 carried_second_rate(const Vec3& r, const Vec3& relative_rate, const Vec3& relative_second_rate,
                         const Vec3& omega, const Vec3& alpha) {
  return relative_second_rate + 2 * omega.cross(relative_rate) +
         attached_second_rate(r, omega, alpha);
}

Mat3 rotation_rate(const Mat3& R, const Vec3& omega) {
  return skew(omega) * R;
}

Mat3 rotation_second_rate(const Mat3& R, const Vec3& omega, const Vec3& alpha) {
  const Mat3 W = skew(omega);
  return (skew(alpha) + W * W) * R;
}

Mat3 inertia_rate(const Mat3& inertia_world, const Vec3& omega) {
  const Mat3 W = skew(omega);
  return W * inertia_world - inertia_world * W;
}

Quat quaternion_rate(const Quat& q, const Vec3& omega) {
  return vector_times(0.5 * omega, q);
}

Quat quaternion_second_rate(const Quat& q, const Vec3& omega, const Vec3& alpha) {
  // (0, omega)^2 = -|omega|^2
  Quat out = vector_times(0.5 * alpha, q);
  out.coeffs() -= 0.25 * omega.squaredNorm() * q.coeffs();
  return out;
}

Vec3 omega_of(const Quat& q, const Quat& rate) {
  return 2 * (rate * q.conjugate()).vec();
}

Vec3 unit_vector_rate(const Vec3& v, const Vec3& rate) {
  const double length = v.norm();
  const Vec3 n = v / length;
  return (rate - n.dot(rate) * n) / length;
}

Vec3 unit_vector_second_rate(const Vec3& v, const Vec3& rate, const Vec3& second_rate) {
  // n'' = (P v'' - (n' n^T + n n'^T) v' - l' n') / l with P = 1 - n n^T, l = |v|, l' = n . v'
  const double length = v.norm();
  const Vec3 n = v / length;
  const double along = n.dot(rate);
  const Vec3 n1 = (rate - along * n) / length;
  return (second_rate - n.dot(second_rate) * n - 2 * along * n1 - n1.dot(rate) * n) / length;
}

bool tangent_frame_rate(const Vec3& n, const Vec3& n_rate, Vec3& t1_rate, Vec3& t2_rate) {
  // The frame and the form of tangent_frame(); k = 1 / (1 + z), so that k' = -k^2 z'.
  static const Vec3 a = Vec3(3, -6, 2) / 7, b = Vec3(6, 2, -3) / 7, c = Vec3(2, 3, 6) / 7;
  const double x = n.dot(a), y = n.dot(b), z = n.dot(c), square = x * x + y * y;
  if (z < 0 && square < 1e-30) return false;
  const double k = z >= 0 ? 1 / (1 + z) : (1 - z) / square;
  const double x1 = n_rate.dot(a), y1 = n_rate.dot(b), z1 = n_rate.dot(c), k1 = -k * k * z1;
  const double mixed = k1 * x * y + k * x1 * y + k * x * y1;
  t1_rate = -(k1 * x * x + 2 * k * x * x1) * a - mixed * b - x1 * c;
  t2_rate = -mixed * a - (k1 * y * y + 2 * k * y * y1) * b - y1 * c;
  return true;
}

}  // namespace tumble
