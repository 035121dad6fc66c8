#pragma once
#include "engine/core/result.hpp"
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/joints/joint_kinds.hpp"
#include "engine/dynamics/joints/joint_push.hpp"

#include <array>
#include <memory>
#include <string>

namespace tumble {

/// Everything needed to make a joint between two bodies, or between the world and a body.
struct JointDef {
  std::string name;
  JointKind kind = JointKind::spherical;
  BodyId a;  ///< null: the world
  BodyId b;
  /// The joint's frame on each body, in its definition's body frame (of the world: in the world):
  /// the origin is the anchor [m], the z axis the joint's main axis.
  Pose frame_a, frame_b;
  double length = 1;     ///< of a distance joint [m]
  bool collide = false;  ///< whether the two bodies may touch each other
  /// What acts along the coordinates, in the order of the kind's list; the rest does nothing.
  JointDrives drives;
  /// The joint is removed after a tick in whose mean it bore more than this: force [N], torque
  /// about the anchor [N m].
  double break_force = no_bound, break_torque = no_bound;

  bool breaks() const { return break_force < no_bound || break_torque < no_bound; }
};

/// Checks what a definition can tell by itself. Errors name the value.
Status validate(const JointDef& def);

/// Stands for the world where a joint names a body slot.
inline constexpr uint32_t no_body = ~uint32_t{0};

/// A live joint: what a step reads, by body slots. Forces, values, rates and what motors did are
/// state, the rest follows from the definition.
struct Joint {
  JointKind kind = JointKind::spherical;
  uint32_t a = no_body, b = no_body;
  /// Anchor relative to the centre of mass, body axes [m]; orientation in body axes.
  Pose frame_a, frame_b;
  double length = 1;
  bool collide = false;
  std::shared_ptr<const JointDrives> drives;  ///< null: nothing acts along the coordinates
  /// By row, before the bodies moved in the last sub-step and after it, without what worked off
  /// errors [N] or [N m]: warm start. Their sum acts on B.
  /// Behind the rows of the parts, those of the coordinates.
  std::array<double, JointRows::most> moving_force{}, relaxing_force{};
  /// By coordinate, after the last tick: value, angles counted over full turns, and rate.
  std::array<double, most_coordinates> value{}, rate{};
  /// By coordinate, over the last tick [N s] or [N m s].
  std::array<double, most_coordinates> motor_impulse{};
  JointPush push;       ///< of the tick so far; no state
  uint8_t coupled = 0;  ///< by coordinate a bit: a JointCoupling names it

  /// Whether its coordinates must be followed from tick to tick: full turns are counted. Those of a
  /// ball joint have no meaning of their own unless something acts on them.
  bool followed() const { return drives || coupled || entry_of(kind).counts_turns(); }
  bool driven(size_t coordinate) const { return drives && (*drives)[coordinate].acts(); }
  bool is_coupled(size_t coordinate) const { return (coupled >> coordinate & 1) != 0; }
};

/// The live joint of a valid definition; both bodies exist. Angles are within half a turn.
Joint make_joint(const JointDef& def, const BodySet& bodies);

/// The joint's ends at the bodies' present poses and velocities. The blocks are the slots.
JointSides joint_sides(const Joint& joint, std::span<const RigidBody> bodies);
/// The same but for the blocks, which stay what they are; axes stay too where no part asks for
/// them.
void put_joint_sides(const Joint& joint, std::span<const RigidBody> bodies, JointSides& out);
/// The same from two poses and velocities; null stands for the world.
JointSide joint_side(const Pose& frame, const RigidBody* body);

/// Writes nothing but the joint's rows, from `out` on, and returns what is behind them.
JointRow* joint_rows(JointKind kind, const JointSides& sides, JointRow* out);
/// Appends them.
inline void joint_rows(JointKind kind, const JointSides& sides, JointRows& out) {
  out.end_at(joint_rows(kind, sides, out.end()));
}
/// How many these are.
size_t row_count(JointKind kind);

/// Sides with axes, whatever the parts ask for.
JointSides sides_with_axes(const Joint& joint, std::span<const RigidBody> bodies);
/// J v of a row at the velocities of the sides.
double row_rate(const JointRow& row, const JointSides& sides);
/// Values and rates of the coordinates from the bodies' present state, those that were there `h`
/// seconds before known: full turns are counted by the mean rate. `solved`: of the driven and the
/// coupled ones the joint has the present values but for rounding, as solvers leave them.
void follow_coordinates(Joint& joint, std::span<const RigidBody> bodies, double h,
                        bool solved = false);
/// Potential energy of springs and compliant limits, kinetic energy of armatures [J].
struct JointEnergies {
  double potential = 0, kinetic = 0;
  double total() const { return potential + kinetic; }
};
/// Of all joints, at the bodies' present state.
JointEnergies energy_of_joints(std::span<const Joint> joints, std::span<const RigidBody> bodies);

}  // namespace tumble
