#pragma once
#include "engine/core/result.hpp"
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/joints/joint_kinds.hpp"

#include <array>
#include <string>

namespace tumble {

struct JointTag;
using JointId = Handle<JointTag>;

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
};

/// Checks what a definition can tell by itself. Errors name the value.
Status validate(const JointDef& def);

/// Stands for the world where a joint names a body slot.
inline constexpr uint32_t no_body = ~uint32_t{0};

/// A live joint: what a step reads, by body slots. The
/// forces are state, the rest follows from the
/// definition.
struct Joint {
  JointKind kind = JointKind::spherical;
  uint32_t a = no_body, b = no_body;
  /// Anchor relative to the centre of mass, body axes [m]; orientation in body axes.
  Pose frame_a, frame_b;
  double length = 1;
  bool collide = false;
  /// By row, of the two passes of the last sub-step [N] or [N m]: warm start. Their sum acts on B.
  std::array<double, JointRows::most> moving_force{}, relaxing_force{};
};

/// The live joint of a valid definition; both bodies exist.
Joint make_joint(const JointDef& def, const BodySet& bodies);

/// The joint's ends at the bodies' present poses and velocities. The blocks are the slots.
JointSides joint_sides(const Joint& joint, std::span<const RigidBody> bodies);
/// The same from two poses and velocities; null stands for the world.
JointSide joint_side(const Pose& frame, const RigidBody* body);

/// Appends nothing but the joint's rows.
void joint_rows(JointKind kind, const JointSides& sides, JointRows& out);
/// How many these are.
size_t row_count(JointKind kind);

}  // namespace tumble
