#include "engine/dynamics/forces/well.hpp"

#include "engine/math/det/det.hpp"

namespace tumble {

Vec3 AttractorDef::acceleration(const Vec3& x) const {
  const Vec3 d = x - centre;
  if (!(radius > 0)) return -strength * d;
  return -strength * det::exp(-d.squaredNorm() / (radius * radius)) * d;
}

double AttractorDef::potential(const Vec3& x) const {
  const double d2 = (x - centre).squaredNorm();
  if (!(radius > 0)) return 0.5 * strength * d2;
  return -0.5 * strength * radius * radius * det::exp(-d2 / (radius * radius));
}

Vec3 RepulsorDef::acceleration(const Vec3& x) const {
  const Vec3 d = x - centre;
  return strength * det::exp(-d.squaredNorm() / (radius * radius)) * d;
}

double RepulsorDef::potential(const Vec3& x) const {
  const double d2 = (x - centre).squaredNorm();
  return 0.5 * strength * radius * radius * det::exp(-d2 / (radius * radius));
}

}  // namespace tumble
