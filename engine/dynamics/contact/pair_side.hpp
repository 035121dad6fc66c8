#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/bodies/proxies.hpp"

#include <cstdint>

namespace tumble {

/// What pairs ask of one shape of one body, gathered once a tick: in a heap each takes part in many
/// pairs, and bodies are large.
struct PairSide {
  Pose shape_pose;  ///< of the shape in the world
  Pose body_pose;   ///< of the body
  /// Of the shape at the end of the tick, if nothing but gravity acts; of a kinematic body, that of
  /// its centre, for how it turns is not foreseen [m/s].
  Vec3 end_velocity = Vec3::Zero();
  double turning = 0;                    ///< ShapeTurning::reach; of a kinematic body 0 [m]
  /// tumble::foresight; infinite of what nothing moves, or looks far [m].
  double foresight = 0;
  double margin = 0;                     ///< contact_margin [m]
  double radius = 0;                     ///< RigidBody::bounding_radius [m]
  double shape_radius = 0;               ///< Shape::bounding_radius [m]
  Vec3 belt = Vec3::Zero();              ///< Material::surface_velocity in world axes [m/s]
  double friction = 0, restitution = 0;  ///< Material
  /// Likewise; 0 of particles, which cannot turn [m].
  double rolling_friction = 0, torsional_friction = 0;
  const Shape* shape = nullptr;
  uint32_t body = 0, shape_index = 0;  ///< ShapeRef
  bool dynamic = false;
  bool polyhedral = false;  ///< its surface is made of triangles or polygons
  bool planes = false;      ///< likewise, or a plane
  bool mesh = false;
  bool particle = false;  ///< is_particle
  bool sphere = false;    ///< so cheap to look at that nothing is noted of it
};

/// `margin` is RealtimeSettings::speculative_margin [m].
PairSide pair_side(std::span<const RigidBody> bodies, ShapeRef ref, const Vec3& gravity, double h,
                   double margin);

}  // namespace tumble
