#pragma once
#include "engine/core/result.hpp"
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/joints/joint_kinds.hpp"
#include "engine/dynamics/joints/joint_push.hpp"

#include <array>
#include <memory>
#include <string>

namespace tumble {

/// Definition of a joint between two bodies, or between the world and a body.
struct JointDef {
  std::string name;
  JointKind kind = JointKind::spherical;
  BodyId a;  ///< null: the world
  BodyId b;
  /// The joint's frame on each body, in the body frame of its definition (for the world: in world
  /// axes): the origin is the anchor [m], the z axis the main axis of the joint.
  Pose frame_a, frame_b;
  double length = 1;     ///< of a distance joint [m]
  bool collide = false;  ///< whether the two bodies may touch each other
  /// What acts along the coordinates, in the order of the kind's list; further entries are ignored.
  JointDrives drives;
  /// The joint is removed after a tick in which its mean load exceeded this: force [N], torque
  /// about the anchor [N m].
  double break_force = no_bound, break_torque = no_bound;

  bool breaks() const { return break_force < no_bound || break_torque < no_bound; }
};

/// Checks what can be checked without the bodies. Errors name the value.
Status validate(const JointDef& def);

/// Stands for the world where a joint names body slots.
inline constexpr uint32_t no_body = ~uint32_t{0};

/// A live joint with body slots. Forces, values, rates and motor impulses are state; the rest
/// follows from the definition.
struct Joint {
  JointKind kind = JointKind::spherical;
  uint32_t a = no_body, b = no_body;
  /// Anchor relative to the centre of mass, body axes [m]; orientation relative to body axes.
  Pose frame_a, frame_b;
  double length = 1;
  bool collide = false;
  std::shared_ptr<const JointDrives> drives;  ///< null: nothing acts along the coordinates
  /// By row: forces before the bodies moved in the last sub-step, and after it, without those that
  /// correct errors [N] or [N m]; warm start. Their sum acts on B. First the rows of the parts,
  /// then those of coordinates.
  std::array<double, JointRows::most> moving_force{}, relaxing_force{};
  /// By coordinate, after the last tick: value (angles with full turns) and rate.
  std::array<double, most_coordinates> value{}, rate{};
  /// By coordinate: impulse of its motor over the last tick [N s] or [N m s].
  std::array<double, most_coordinates> motor_impulse{};
  /// Over the last tick, with what couplings do along its coordinates: `force` is an impulse
  /// [N s], `torque` an angular impulse [N m s].
  JointWrench impulse;
  uint8_t coupled = 0;  ///< by coordinate, a bit: a JointCoupling names it

  /// Whether its coordinates must be followed from tick to tick to count full turns. Those of a
  /// ball joint matter only if something acts on them.
  bool followed() const { return drives || coupled || entry_of(kind).counts_turns(); }
  bool driven(size_t coordinate) const { return drives && (*drives)[coordinate].acts(); }
  bool is_coupled(size_t coordinate) const { return (coupled >> coordinate & 1) != 0; }
};

/// Mean wrench over the last tick of h seconds.
inline JointWrench mean_load(const Joint& joint, double h) {
  return {joint.impulse.force / h, joint.impulse.torque / h};
}

/// The live joint of a valid definition whose bodies exist. Angles start within half a turn.
Joint make_joint(const JointDef& def, const BodySet& bodies);

/// The joint's ends at the bodies' present poses and velocities, with slots as blocks.
JointSides joint_sides(const Joint& joint, std::span<const RigidBody> bodies);
/// The same without changing the blocks; sets axes only if a part of the joint needs them.
void put_joint_sides(const Joint& joint, std::span<const RigidBody> bodies, JointSides& out);
/// One end, from the pose and velocity of a body; null stands for the world.
JointSide joint_side(const Pose& frame, const RigidBody* body);

/// Writes the joint's rows from `out` on, and returns the place behind them.
JointRow* joint_rows(JointKind kind, const JointSides& sides, JointRow* out);
/// Appends the joint's rows.
inline void joint_rows(JointKind kind, const JointSides& sides, JointRows& out) {
  out.end_at(joint_rows(kind, sides, out.end()));
}
/// Number of these rows.
size_t row_count(JointKind kind);

/// The joint's ends with axes, whether or not its parts need them.
JointSides sides_with_axes(const Joint& joint, std::span<const RigidBody> bodies);
/// J v of a row at the velocities of the sides.
double row_rate(const JointRow& row, const JointSides& sides);
/// Updates values and rates of the coordinates from the bodies' present state; those of `h` seconds
/// ago are known, and full turns are counted by the mean rate. `solved`: driven and coupled
/// coordinates have their present values already, up to rounding, as solvers leave them.
void follow_coordinates(Joint& joint, std::span<const RigidBody> bodies, double h,
                        bool solved = false);
/// Potential energy of springs and soft limits, and kinetic energy of armatures [J].
struct JointEnergies {
  double potential = 0, kinetic = 0;
  double total() const { return potential + kinetic; }
};
/// The sum over all joints, at the bodies' present state.
JointEnergies energy_of_joints(std::span<const Joint> joints, std::span<const RigidBody> bodies);

}  // namespace tumble
