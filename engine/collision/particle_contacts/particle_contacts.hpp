#pragma once
#include "engine/collision/broad_phase.hpp"
#include "engine/collision/motion.hpp"
#include "engine/collision/shape.hpp"
#include "engine/collision/time_of_contact.hpp"
#include "engine/core/result.hpp"

#include <memory>
#include <span>
#include <vector>

namespace tumble {

// Particles are balls. Flat arrays of equal length: index i of each is the same particle.

/// Where particles are.
struct ParticleBalls {
  std::span<const Vec3> x;         ///< centres [m]
  std::span<const double> radius;  ///< >= 0 [m]
};

/// Straight paths of particles: x + t v for t in [0, h].
struct ParticlePaths {
  ParticleBalls start;
  std::span<const Vec3> v;  ///< [m/s]
  double h = 0;             ///< >= 0 [s]
};

/// Two particles that touch or overlap, or nearly so.
struct ParticlePairContact {
  uint32_t a = 0, b = 0;        ///< a < b
  double gap = 0;               ///< negative where they overlap [m]
  Vec3 x = Vec3::Zero();        ///< midway between the surfaces [m]
  Vec3 normal = Vec3::UnitY();  ///< unit, from a to b; +Y for centres in one place
};

/// Two particles that first touch within the tick.
struct ParticlePairMeeting {
  uint32_t a = 0, b = 0;        ///< a < b
  double time = 0;              ///< 0 where they touch from the start; never late [s]
  Vec3 x = Vec3::Zero();        ///< midway between the surfaces then [m]
  Vec3 normal = Vec3::UnitY();  ///< unit, from a to b, then
};

struct StillShape {
  const Shape* shape = nullptr;
  Pose pose;
};

/// A shape that moves over [0, h] of the particles' paths (t0 = 0, t1 = h).
struct MovingShape {
  const Shape* shape = nullptr;
  Motion motion;
};

/// A particle that touches, overlaps or is within a shape, or nearly so. Convex shapes, half-spaces
/// and closed meshes are solid; of an open mesh the surface counts, from either side.
struct ParticleShapeContact {
  uint32_t particle = 0, shape = 0;
  double gap = 0;               ///< negative where they overlap [m]
  Vec3 x = Vec3::Zero();        ///< on the shape's surface [m]
  Vec3 normal = Vec3::UnitY();  ///< unit, from the particle to the shape
  uint32_t triangle = 0;        ///< of a mesh
};

/// A particle that first comes within the tolerance of a shape's surface in the tick.
struct ParticleShapeMeeting {
  uint32_t particle = 0, shape = 0;
  double time = 0;              ///< never late [s]
  Vec3 x = Vec3::Zero();        ///< on the shape's surface then [m]
  Vec3 normal = Vec3::UnitY();  ///< unit, from the particle to the shape
  uint32_t triangle = 0;        ///< of a mesh
  /// initially_overlapping at time 0: from the start, and nothing else of the shape is met;
  /// max_iterations: none before, beyond unknown.
  TimeOfContactStatus status = TimeOfContactStatus::contact;
};

/// Finds contacts of particles with each other and with shapes, now (discrete) and within a tick
/// (continuous); Coutinho 2013 §3.4.1 and §3.4.2. Answers replace what `out` held, are sorted by
/// the two indices, and are the same for any number of threads and whatever was asked before: what
/// is kept is memory only. Arrays of unequal length, values that are not finite, and negative radii
/// are refused with the index.
class ParticleContactFinder {
 public:
  ParticleContactFinder();
  /// Threads to use, or none; until the next call of this they must live.
  void use_threads(Crew* crew);

  /// Pairs with a gap of at most `margin` (>= 0) [m]. Neighbours come from the grid of several
  /// levels (§2.4.2), so that radii may differ widely.
  Status touching_pairs(const ParticleBalls& balls, double margin,
                        std::vector<ParticlePairContact>& out);
  /// Pairs that touch at any time of the tick, each when it first does: the certified quadratic of
  /// moving_spheres_contact().
  Status meeting_pairs(const ParticlePaths& paths, std::vector<ParticlePairMeeting>& out);

  /// Particles with a gap of at most `margin` (>= 0) [m] to a shape.
  Status touching_shapes(const ParticleBalls& balls, std::span<const StillShape> shapes,
                         double margin, std::vector<ParticleShapeContact>& out);
  /// Particles that meet a shape at any time of the tick, both moving, rotation included:
  /// time_of_contact() of balls, so that nothing is passed through, however thin. Radii count as
  /// 10^-6 m at least, the smallest that shapes have, and above 10^6 m are refused. `tolerance` > 0
  /// [m].
  Status meeting_shapes(const ParticlePaths& paths, std::span<const MovingShape> shapes,
                        double tolerance, std::vector<ParticleShapeMeeting>& out);

 private:
  void find_neighbours();

  Crew* crew_ = nullptr;
  std::unique_ptr<BroadPhase> grid_;
  std::vector<BroadPhaseProxy> proxies_;
  std::vector<ProxyPair> pairs_;
};

}  // namespace tumble
