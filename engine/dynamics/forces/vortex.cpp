#include "engine/dynamics/forces/vortex.hpp"

#include "engine/dynamics/forces/tolerances.hpp"
#include "engine/math/det/det.hpp"

namespace tumble {

std::string VortexDef::fault() const {
  return axis.norm() > tolerances::no_axis ? std::string() : "axis must not be zero";
}

VortexDef::Flow VortexDef::at(double) const {
  return {centre, axis.normalized(), circulation / (2 * det::pi), core_radius * core_radius,
          strain};
}

Vec3 VortexDef::Flow::operator()(const Vec3& x) const {
  const Vec3 d = x - centre;
  const double z = axis.dot(d);
  const Vec3 radial = d - z * axis;
  // (1 - exp(-s)) / s, by its series where the difference would lose digits.
  const double s = radial.squaredNorm() / core2;
  const double swirl =
      s < tolerances::exponential_series ? 1 - s / 2 * (1 - s / 3) : (1 - det::exp(-s)) / s;
  return factor * swirl / core2 * axis.cross(radial) - 0.5 * strain * radial + strain * z * axis;
}

}  // namespace tumble
