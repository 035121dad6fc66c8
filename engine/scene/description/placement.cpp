#include "engine/scene/description/placement.hpp"

#include "engine/math/det/det.hpp"
#include "engine/math/rotation.hpp"

#include <cmath>
#include <limits>

namespace tumble {
namespace {

/// Error of the squared norm of a quaternion that was normalised, or is a product of such [-]:
/// within it a quaternion is kept as it is, so that saving and reading preserve its bits.
constexpr double unit_error = 16 * std::numeric_limits<double>::epsilon();

/// Angles written by people have at most nine decimals [1/deg].
constexpr double steps_of_round_angles = 1e9;

}  // namespace

double to_radians(double degrees) {
  return degrees * (det::pi / 180);
}

Quat euler_deg_to_quat(const Vec3& degrees) {
  return euler_xyz({to_radians(degrees.x()), to_radians(degrees.y()), to_radians(degrees.z())});
}

Vec3 quat_to_euler_deg(const Quat& q) {
  return angles_xyz(q) * (180 / det::pi);
}

Pose Placement::pose() const {
  Pose out{position, Quat::Identity()};
  if (orientation)
    out.q = std::fabs(orientation->squaredNorm() - 1) < unit_error ? *orientation
                                                                   : orientation->normalized();
  else if (euler_deg)
    out.q = euler_deg_to_quat(*euler_deg);
  else if (axis && angle_deg)
    out.q = axis_angle(*axis, to_radians(*angle_deg));
  return out;
}

void Placement::turn(const Quat& q) {
  orientation.reset(), axis.reset(), angle_deg.reset(), euler_deg.reset();
  const Vec3 angles = quat_to_euler_deg(q);
  const Vec3 round =  // replaces -0 by 0
      Vec3((angles * steps_of_round_angles).array().round() / steps_of_round_angles) + Vec3::Zero();
  for (const Vec3& turn : {round, angles})
    if (euler_deg_to_quat(turn).coeffs() == q.coeffs()) {
      if (!turn.isZero(0)) euler_deg = turn;
      return;
    }
  orientation = q;
}

void Placement::check(const Placement& d, Complaints& complaints) {
  const int forms =
      int(d.orientation.has_value()) + int(d.euler_deg.has_value()) + int(d.axis || d.angle_deg);
  if (forms > 1)
    complaints.add("", "give one of orientation, euler_deg, or axis with angle_deg, not several");
  if (d.orientation && !(d.orientation->squaredNorm() > 1e-20))
    complaints.add("orientation", "a quaternion of zeros is no orientation");
  if (d.axis && !d.angle_deg) complaints.add("axis", "axis needs angle_deg beside it");
  if (d.angle_deg && !d.axis) complaints.add("angle_deg", "angle_deg needs axis beside it");
  if (d.axis && !(d.axis->squaredNorm() > 1e-20))
    complaints.add("axis", "an axis of zeros has no direction");
}

}  // namespace tumble
