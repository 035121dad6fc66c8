#include "engine/dynamics/forces/point_gravity.hpp"

#include <cmath>

namespace tumble {

Vec3 PointGravityDef::acceleration(const Vec3& x) const {
  const Vec3 d = x - centre;
  const double r2 = d.squaredNorm() + softening * softening;
  if (!(r2 > 0)) return Vec3::Zero();  // at the centre itself no direction is down
  return -mu / (r2 * std::sqrt(r2)) * d;
}

double PointGravityDef::potential(const Vec3& x) const {
  const double r2 = (x - centre).squaredNorm() + softening * softening;
  return r2 > 0 ? -mu / std::sqrt(r2) : 0;
}

}  // namespace tumble
