#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/bodies/proxies.hpp"

#include <cstdint>

namespace tumble {

/// What a contact takes from the material of a shape.
struct SideSurface {
  Vec3 belt = Vec3::Zero();              ///< Material::surface_velocity in world axes [m/s]
  double friction = 0, restitution = 0;  ///< Material
  /// Likewise; 0 of particles, which cannot turn [m].
  double rolling_friction = 0, torsional_friction = 0;
};

/// Whether the surface of a shape is made of triangles or polygons, or is a plane.
bool made_of_planes(const Shape& shape);

/// What pairs ask of one body, or of one of its shapes, gathered once a tick: in a heap each takes
/// part in many pairs, and bodies are large.
struct PairSide : SideSurface {
  /// Pose of the shape in the world; of a body that is paired as a whole, pose of the body.
  Pose shape_pose;
  Pose body_pose;  ///< of the body
  /// Of the shape at the end of the tick, if nothing but gravity acts; of a kinematic body, for how
  /// it turns is not foreseen, and of a whole one, that of its centre [m/s].
  Vec3 end_velocity = Vec3::Zero();
  /// ShapeTurning::reach; of a body that is paired as a whole, how far its rotation about the
  /// centre moves any point; of a kinematic one 0 [m].
  double turning = 0;
  /// tumble::foresight; infinite of immovable bodies, and of those that look far [m].
  double foresight = 0;
  double margin = 0;        ///< contact_margin [m]
  double radius = 0;        ///< RigidBody::bounding_radius [m]
  double shape_radius = 0;  ///< Shape::bounding_radius; of a whole body `radius` [m]
  const Shape* shape = nullptr;
  const RigidBody* several = nullptr;  ///< the body that is paired as a whole; else null
  uint32_t body = 0, shape_index = 0;  ///< ShapeRef; of a whole body its first shape
  bool dynamic = false;
  bool polyhedral = false;  ///< its surface is made of triangles or polygons
  bool planes = false;      ///< made_of_planes
  bool mesh = false;
  bool particle = false;  ///< is_particle
  bool sphere = false;    ///< so cheap to look at that nothing is noted of it

  /// Of one of the shapes of a whole body, else its own.
  SideSurface surface_of(uint32_t shape) const;
};

/// Whether one of them is a whole body, of several shapes.
inline bool in_pieces(const PairSide& a, const PairSide& b) {
  return a.several || b.several;
}

/// What there is for all sides of a tick.
struct SideTick {
  Vec3 gravity = Vec3::Zero();  ///< [m/s2]
  double h = 0;                 ///< [s]
  double margin = 0;            ///< RealtimeSettings::speculative_margin [m]
};

/// Of one shape of a body.
PairSide shape_side(std::span<const RigidBody> bodies, ShapeRef ref, const SideTick& tick);
/// Of what has a proxy: of a body that is paired as a whole (RigidBody::tree), which has a property
/// of shapes if all of them have; or of one shape.
PairSide pair_side(std::span<const RigidBody> bodies, ShapeRef ref, const SideTick& tick);

}  // namespace tumble
