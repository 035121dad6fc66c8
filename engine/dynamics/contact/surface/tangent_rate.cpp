#include "engine/dynamics/contact/surface/tangent_rate.hpp"

#include "engine/math/rotation_rates.hpp"

namespace tumble {

Vec3 follow_normal_rate(const Vec3& n, const Vec3& n_rate, const Vec3& tangent) {
  // The rotation without spin about n has angular velocity n x n'.
  return n.cross(n_rate).cross(tangent);
}

bool slip_tangent_rate(const Vec3& n, const Vec3& n_rate, const Vec3& velocity,
                       const Vec3& acceleration, TangentRate& out) {
  const double along = n.dot(velocity);
  const Vec3 slip = velocity - along * n;
  if (!(slip.squaredNorm() > 0)) return false;
  const Vec3 slip_rate =
      acceleration - (n.dot(acceleration) + n_rate.dot(velocity)) * n - along * n_rate;
  out.t1 = slip.normalized();
  out.t1_rate = unit_vector_rate(slip, slip_rate);
  out.t2 = n.cross(out.t1);
  out.t2_rate = n_rate.cross(out.t1) + n.cross(out.t1_rate);
  return true;
}

}  // namespace tumble
