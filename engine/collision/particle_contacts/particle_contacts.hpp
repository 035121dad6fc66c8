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

// Particles are balls, given by arrays of equal length: the same index is the same particle.

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

/// Two particles whose gap is at most the margin; they may overlap.
struct ParticlePairContact {
  uint32_t a = 0, b = 0;        ///< a < b
  double gap = 0;               ///< negative where they overlap [m]
  Vec3 x = Vec3::Zero();        ///< midway between the surfaces [m]
  Vec3 normal = Vec3::UnitY();  ///< unit, from a to b; +Y for coinciding centres
};

/// Two particles that first touch within the tick.
struct ParticlePairMeeting {
  uint32_t a = 0, b = 0;        ///< a < b
  double time = 0;              ///< 0 if they touch at the start; never later than the contact [s]
  Vec3 x = Vec3::Zero();        ///< midway between the surfaces at that time [m]
  Vec3 normal = Vec3::UnitY();  ///< unit, from a to b, at that time
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

/// A particle whose gap to a shape is at most the margin; it may be inside. Convex shapes,
/// half-spaces and closed meshes are solid; an open mesh is a surface with two sides.
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
  double time = 0;              ///< never later than the contact [s]
  Vec3 x = Vec3::Zero();        ///< on the shape's surface, at that time [m]
  Vec3 normal = Vec3::UnitY();  ///< unit, from the particle to the shape
  uint32_t triangle = 0;        ///< of a mesh
  /// initially_overlapping: at time 0, and nothing else of the shape is met. max_iterations: no
  /// contact before this time, unknown beyond.
  TimeOfContactStatus status = TimeOfContactStatus::contact;
};

/// Finds contacts of particles with each other and with shapes, at one time (discrete) and within a
/// tick (continuous); Coutinho 2013 §3.4.1 and §3.4.2. Results overwrite `out`, are sorted by the
/// two indices, and depend neither on the number of threads nor on earlier calls: only memory is
/// kept. Arrays of unequal length, values that are not finite, and negative radii are refused with
/// an error that names the index.
class ParticleContactFinder {
 public:
  ParticleContactFinder();
  /// Threads to use, or null; they must live until the next call of this function.
  void use_threads(Crew* crew);

  /// Pairs with a gap of at most `margin` (>= 0) [m]. Neighbours are found by the multi-level grid
  /// (§2.4.2), so that radii may differ widely.
  Status touching_pairs(const ParticleBalls& balls, double margin,
                        std::vector<ParticlePairContact>& out);
  /// Pairs that touch at any time of the tick, with the first time: the certified quadratic
  /// equation of moving_spheres_contact().
  Status meeting_pairs(const ParticlePaths& paths, std::vector<ParticlePairMeeting>& out);

  /// Particles with a gap of at most `margin` (>= 0) [m] to a shape.
  Status touching_shapes(const ParticleBalls& balls, std::span<const StillShape> shapes,
                         double margin, std::vector<ParticleShapeContact>& out);
  /// Particles that touch a moving shape at any time of the tick, by time_of_contact() of balls,
  /// rotation included: nothing is passed through, however thin. Radii below 10^-6 m, the smallest
  /// size of a shape, count as that; radii above 10^6 m are refused. `tolerance` > 0 [m].
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
