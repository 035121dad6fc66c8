#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/bodies/proxies.hpp"

#include <cstdint>

namespace tumble {

/// What a contact takes from the material of a shape, world axes.
struct SideSurface {
  Vec3 belt = Vec3::Zero();              ///< Material::surface_velocity in world axes [m/s]
  double friction = 0, restitution = 0;  ///< Material
  /// Lever arms of Material; 0 for particles, which cannot turn [m].
  double rolling_friction = 0, torsional_friction = 0;
};

/// Whether the surface of a shape is made of triangles or polygons, or is a plane.
bool made_of_planes(const Shape& shape);

/// What pairs need of one body, or of one of its shapes, gathered once per tick: in a heap each
/// body takes part in many pairs, and bodies are large structures.
struct PairSide : SideSurface {
  /// Pose of the shape in the world; of a body that is paired as a whole, pose of the body.
  Pose shape_pose;
  Pose body_pose;  ///< of the body
  /// Velocity at the end of the tick if nothing but gravity acts [m/s]: of the shape's centre; of a
  /// kinematic body, whose rotation is not foreseen, and of a body that is paired as a whole,
  /// velocity of its centre of mass.
  Vec3 end_velocity = Vec3::Zero();
  /// ShapeTurning::reach; of a body that is paired as a whole, how far its rotation about the
  /// centre of mass can move any point in the tick; of a kinematic one 0 [m].
  double turning = 0;
  /// tumble::foresight; infinite of immovable bodies, and of those that look far [m].
  double foresight = 0;
  double margin = 0;  ///< contact_margin [m]
  double radius = 0;  ///< RigidBody::bounding_radius [m]
  /// Shape::bounding_radius; of a body that is paired as a whole, `radius` [m]
  double shape_radius = 0;
  const Shape* shape = nullptr;
  const RigidBody* several = nullptr;  ///< the body, if it is paired as a whole; otherwise null
  /// ShapeRef; of a body that is paired as a whole, its first shape.
  uint32_t body = 0, shape_index = 0;
  bool dynamic = false;
  bool polyhedral = false;  ///< its surface is made of triangles or polygons
  bool planes = false;      ///< made_of_planes
  bool mesh = false;
  bool particle = false;  ///< is_particle
  bool sphere = false;    ///< is a ball: the narrow phase is so cheap that its result is not cached

  /// Surface of one shape of a body that is paired as a whole; otherwise that of this side.
  SideSurface surface_of(uint32_t shape) const;
};

/// Whether at least one of them is a body that is paired as a whole.
inline bool in_pieces(const PairSide& a, const PairSide& b) {
  return a.several || b.several;
}

/// What all sides of a tick have in common.
struct SideTick {
  Vec3 gravity = Vec3::Zero();  ///< [m/s2]
  double h = 0;                 ///< length of the tick [s]
  double margin = 0;            ///< RealtimeSettings::speculative_margin [m]
};

/// The side for one shape of a body.
PairSide shape_side(std::span<const RigidBody> bodies, ShapeRef ref, const SideTick& tick);
/// The side for a proxy: a body that is paired as a whole (RigidBody::tree), which has a property
/// of shapes (planes, mesh, polyhedral) if all of them have it; or one shape.
PairSide pair_side(std::span<const RigidBody> bodies, ShapeRef ref, const SideTick& tick);

}  // namespace tumble
