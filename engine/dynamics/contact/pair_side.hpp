#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/bodies/proxies.hpp"

#include <cstdint>

namespace tumble {

/// What a contact takes from the material of one of its sides.
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
struct PairSide {
  /// Of the shape in the world; of a body of several shapes that of the body.
  Pose shape_pose;
  Pose body_pose;  ///< of the body
  /// Of the shape at the end of the tick, if nothing but gravity acts; of a kinematic body, and of
  /// one of several shapes, that of its centre [m/s].
  Vec3 end_velocity = Vec3::Zero();
  /// ShapeTurning::reach; of a body of several shapes how far it turns about its centre; of a
  /// kinematic body 0, for how it turns is not foreseen [m].
  double turning = 0;
  double foresight = 0;     ///< tumble::foresight; of what nothing moves infinite [m]
  double margin = 0;        ///< contact_margin [m]
  double radius = 0;        ///< RigidBody::bounding_radius [m]
  double shape_radius = 0;  ///< Shape::bounding_radius; of a body of several shapes `radius` [m]
  SideSurface surface;      ///< of the shape
  const Shape* shape = nullptr;
  const RigidBody* several = nullptr;  ///< the body that has several shapes; else null
  uint32_t body = 0;                   ///< slot
  bool dynamic = false;
  bool polyhedral = false;  ///< its surface is made of triangles or polygons
  bool planes = false;      ///< made_of_planes
  bool mesh = false;
  bool particle = false;  ///< is_particle
  bool sphere = false;    ///< so cheap to look at that nothing is noted of it

  /// Of one of its shapes.
  SideSurface surface_of(uint32_t shape_index) const;
};

/// What there is for all sides of a tick.
struct SideTick {
  Vec3 gravity = Vec3::Zero();  ///< [m/s2]
  double h = 0;                 ///< [s]
  double margin = 0;            ///< RealtimeSettings::speculative_margin [m]
};

/// Of one shape of a body.
PairSide shape_side(std::span<const RigidBody> bodies, ShapeRef ref, const SideTick& tick);
/// Of a whole body, which has shapes. Where there are several, it has a property of shapes if all
/// of them have.
PairSide body_side(std::span<const RigidBody> bodies, uint32_t slot, const SideTick& tick);

}  // namespace tumble
