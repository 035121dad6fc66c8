#pragma once
#include "engine/collision/time_of_contact.hpp"
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/particles/particle_system.hpp"

#include <functional>
#include <limits>
#include <vector>

namespace tumble {

// Queries to a world and their results; QueryScene answers them.

/// What a query found: a shape of a body, or a particle.
struct QueryTarget {
  BodyId body;                 ///< null for a particle
  uint32_t shape = 0;          ///< index in BodyInfo::shapes
  ParticleSystemId particles;  ///< null for a body
  uint32_t particle = 0;       ///< index in the arrays of the ParticleFrame

  bool is_particle() const { return !particles.is_null(); }
  friend bool operator==(const QueryTarget&, const QueryTarget&) = default;
  /// Bodies before particles, then by ids: the order of answers that are equal otherwise.
  friend bool operator<(const QueryTarget& a, const QueryTarget& b) {
    if (a.is_particle() != b.is_particle()) return b.is_particle();
    if (a.body != b.body) return a.body < b.body;
    if (a.shape != b.shape) return a.shape < b.shape;
    if (a.particles != b.particles) return a.particles < b.particles;
    return a.particle < b.particle;
  }
};

/// What a query takes into account.
struct QueryFilter {
  bool fixed = true, kinematic = true, dynamic = true;  ///< bodies of this type
  bool particles = false;                               ///< particles too, as balls of their radius
  std::vector<BodyId> leave_out = {};                   ///< these bodies are ignored
  /// The last test, if not empty; called before a shape's geometry is tested, for some shapes only
  /// and in no particular order, on the thread of the query.
  std::function<bool(const QueryTarget&)> accept = {};
};

/// A ray in the world. With a zero direction the query finds the solids that contain the origin.
struct RayQuery {
  Vec3 origin = Vec3::Zero();                                     ///< [m]
  Vec3 direction = Vec3::UnitX();                                 ///< of any length
  double max_distance = std::numeric_limits<double>::infinity();  ///< >= 0 [m]
  /// Whether a convex shape, half-space or particle that contains the origin is hit there, at
  /// distance 0; otherwise the ray passes through it. Rays hit meshes as surfaces, from either
  /// side.
  bool hit_inside = true;
};

struct RayQueryHit {
  QueryTarget target;
  double distance = 0;          ///< along the ray [m]
  Vec3 x_world = Vec3::Zero();  ///< [m]
  Vec3 normal = Vec3::Zero();   ///< unit, outward, world axes; against the ray where it starts
                                ///< inside, zero where it has no direction
  uint32_t feature = 0;         ///< triangle of a mesh, face of a polyhedron
};

/// A moving shape: from `start`, translation and rotation at constant velocity, over fractions 0 to
/// 1 of the motion.
struct CastQuery {
  Pose start;                       ///< of the shape's frame
  Vec3 translation = Vec3::Zero();  ///< of the frame's origin [m]
  Vec3 rotation = Vec3::Zero();     ///< about it: axis times angle, world axes [rad]
  double tolerance = 1e-5;          ///< nearer than this counts as contact (> 0) [m]
  /// Whether shapes that it touches at the start are hit there, at fraction 0. Otherwise it may
  /// move out of them, also through convex shapes; of a mesh only the triangles that it does not
  /// touch stop it.
  bool hit_at_start = true;
};

struct CastHit {
  QueryTarget target;
  double fraction = 0;  ///< fraction of the motion, never later than the contact [-]
  /// Point of the target nearest to the moving shape at that time [m].
  Vec3 x_world = Vec3::Zero();
  Vec3 normal = Vec3::Zero();  ///< unit, out of the target; zero if one shape contains the other
  /// initially_overlapping: at fraction 0. max_iterations: no contact before this fraction, unknown
  /// beyond.
  TimeOfContactStatus status = TimeOfContactStatus::contact;
};

/// The point of a shape's surface nearest to a query point.
struct NearHit {
  QueryTarget target;
  double distance = 0;          ///< negative inside solids, never for open meshes [m]
  Vec3 x_world = Vec3::Zero();  ///< on the surface [m]
  Vec3 normal = Vec3::Zero();   ///< unit, outward; of open meshes towards the query point
  uint32_t triangle = 0;        ///< of a mesh
};

}  // namespace tumble
