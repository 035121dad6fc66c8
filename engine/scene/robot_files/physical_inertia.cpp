#include "engine/scene/robot_files/physical_inertia.hpp"

#include "engine/geometry/mass_properties/principal_axes.hpp"
#include "engine/scene/robot_files/tolerances.hpp"

namespace tumble {

std::optional<PhysicalInertia> physical_inertia(const Mat3& given) {
  const PrincipalAxes principal = principal_axes(given);
  const Vec3 second = 0.5 * principal.moments.sum() - principal.moments.array();
  const double largest = second.maxCoeff();
  if (!(largest > 0)) return std::nullopt;
  PhysicalInertia out;
  out.given = principal.moments;
  out.inertia = given;
  // Two zero second moments belong to a line without thickness, which has no inertia about itself.
  Vec3 made = second.cwiseMax(0);
  const int small = int((second.array() < robot_tolerances::thinnest * largest).count());
  if (small == 2) made = second.cwiseMax(robot_tolerances::thinnest * largest);
  out.made = made.sum() - made.array();
  out.changed = small == 2 || second.minCoeff() < -robot_tolerances::second_moment * largest;
  if (made != second)
    out.inertia = principal.axes * out.made.asDiagonal() * principal.axes.transpose();
  out.inertia = 0.5 * (out.inertia + out.inertia.transpose());
  return out;
}

}  // namespace tumble
