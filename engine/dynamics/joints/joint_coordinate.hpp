#pragma once
#include "engine/dynamics/joints/joint_part.hpp"

#include <cmath>
#include <numbers>
#include <string_view>

namespace tumble {

/// The value of a coordinate as `error` of a row, with its Jacobian and dJ/dt v. Angles are within
/// one turn.
using CoordinateRow = JointRow (*)(const JointSides& sides);

/// A relative motion that a joint leaves free.
struct JointCoordinate {
  std::string_view name;
  CoordinateRow row;
  bool angle = false;  ///< [rad], else [m]
  bool turns = false;  ///< an angle of which full turns are counted
};

/// The angle nearest to an expected one among those that differ from `angle` by full turns [rad].
inline double nearest_turn(double angle, double expected) {
  constexpr double turn = 2 * std::numbers::pi;
  return angle + turn * std::round((expected - angle) / turn);
}

// The coordinates, each in a file of its own, except for those along the axes of A's frame.

/// Rotation of B about the common z axis: the twist of the rotation from A's frame to B's, which
/// remains after the shortest swing of the z axes. Its rate is (z_a + z_b).(omega_b - omega_a) / (1
/// + z_a.z_b); undefined if the axes are opposite.
JointRow twist_angle(const JointSides& sides);
/// Angle between the z axes of both frames, 0 .. pi.
JointRow swing_angle(const JointSides& sides);
/// Of a universal joint: direction of x of B, as an angle about z of A.
JointRow first_angle(const JointSides& sides);
/// Of a universal joint: rotation of B about its own x axis.
JointRow second_angle(const JointSides& sides);
/// Position of B's anchor relative to A's, along an axis of A's frame.
JointRow offset_x(const JointSides& sides);
JointRow offset_y(const JointSides& sides);
JointRow offset_z(const JointSides& sides);
/// Distance of the anchors.
JointRow anchor_distance(const JointSides& sides);

}  // namespace tumble
