#pragma once
#include "engine/dynamics/joints/joint_part.hpp"

#include <cmath>
#include <numbers>
#include <string_view>

namespace tumble {

/// A coordinate's value as `error` of a row, with its Jacobian and dJ/dt v. Angles are within one
/// turn.
using CoordinateRow = JointRow (*)(const JointSides& sides);

/// A direction that a joint leaves free, and that has a name.
struct JointCoordinate {
  std::string_view name;
  CoordinateRow row;
  bool angle = false;  ///< [rad], else [m]
  bool turns = false;  ///< an angle that is counted over full turns
};

/// An angle, known but for full turns, that is nearest to an expected one [rad].
inline double nearest_turn(double angle, double expected) {
  constexpr double turn = 2 * std::numbers::pi;
  return angle + turn * std::round((expected - angle) / turn);
}

// The coordinates; each is in a file of its own, but for those along the axes of A's frame.

/// Turn of B about the common z axis: the twist of the rotation from A's frame to B's, which is
/// what remains after the shortest swing of the z axes. Its rate is
/// (z_a + z_b).(omega_b - omega_a) / (1 + z_a.z_b); it has none where the axes are opposite.
JointRow twist_angle(const JointSides& sides);
/// Angle between the z axes of both frames, 0 .. pi.
JointRow swing_angle(const JointSides& sides);
/// Of a universal joint: where x of B points, about z of A.
JointRow first_angle(const JointSides& sides);
/// Of a universal joint: how far B has turned about its own x axis.
JointRow second_angle(const JointSides& sides);
/// B's anchor seen from A's, along an axis of A's frame.
JointRow offset_x(const JointSides& sides);
JointRow offset_y(const JointSides& sides);
JointRow offset_z(const JointSides& sides);
/// Distance of the anchors.
JointRow anchor_distance(const JointSides& sides);

}  // namespace tumble
