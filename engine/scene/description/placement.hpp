#pragma once
#include "engine/scene/description/values.hpp"

namespace tumble {

/// Position and orientation; the orientation in at most one of three forms.
struct Placement {
  Vec3 position = Vec3::Zero();     ///< [m]
  std::optional<Quat> orientation;  ///< w, x, y, z; normalised unless its norm is 1 up to rounding
  std::optional<Vec3> euler_deg;    ///< about x, then the new y, then the new z [deg]
  std::optional<Vec3> axis;         ///< with angle_deg
  std::optional<double> angle_deg;  ///< [deg]

  /// The pose of this frame in its parent.
  Pose pose() const;

  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.position,
            {.name = "position", .unit = "m", .min = -1e7, .max = 1e7, .doc = "origin"});
    v.field(d.orientation, {.name = "orientation", .doc = "quaternion [w, x, y, z]"});
    v.field(d.euler_deg, {.name = "euler_deg",
                          .unit = "deg",
                          .min = -1e6,
                          .max = 1e6,
                          .doc = "turns about x, then the new y, then the new z"});
    v.field(d.axis, {.name = "axis", .min = -1e9, .max = 1e9, .doc = "turn about this axis"});
    v.field(d.angle_deg, {.name = "angle_deg",
                          .unit = "deg",
                          .min = -1e6,
                          .max = 1e6,
                          .doc = "by this angle (with axis)"});
  }
  static void check(const Placement& d, Complaints& complaints);

  /// Sets the orientation: by angles if some give exactly these bits, preferably round ones,
  /// otherwise by the quaternion.
  void turn(const Quat& q);
};

/// Orientation from angles in degrees about x, the new y and the new z.
Quat euler_deg_to_quat(const Vec3& degrees);
Vec3 quat_to_euler_deg(const Quat& q);
double to_radians(double degrees);

}  // namespace tumble
