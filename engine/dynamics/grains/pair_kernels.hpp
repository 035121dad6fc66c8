#pragma once
#include "engine/dynamics/grains/grain_bundles.hpp"

namespace tumble {

/// What rows of pairs act on, and they themselves.
struct GrainPairView {
  GrainPoint* points;
  GrainMover* movers;
  GrainBundle* bundles;
  GrainTurning* turnings;  ///< by bundle, or null
  GrainBounce* bounces;    ///< by bundle, or null
};

/// Work done in a part, in lanes that are summed up at its end: of normal impulses, and of friction
/// and torques [J].
struct GrainWork {
  alignas(64) std::array<double, grain_lanes> lost{}, rubbed{};
};

// The inner loops over bundles, on the widest vectors that the machine has. Lanes never mix, and
// nothing is fused or approximated, so that all machines get the same bits. Each works through a
// range of bundles in order.

/// Ways, gaps and shares at the present places.
void follow_pairs(const GrainPairView& in, GrainRange range);
/// The impulses of the sub-step before, turned into the present tangent planes.
void warm_start_pairs(const GrainPairView& in, GrainRange range, GrainWork& work);
/// Rolling and torsion, friction, normals; with `follows` at the present places.
void sweep_pairs(const GrainPairView& in, GrainRange range, double inverse_hs, bool follows,
                 GrainWork& work);
/// Moves grains apart that overlap, without giving them speed: sweeps that have not converged would
/// turn such speed into bouncing.
void part_overlapping_pairs(const GrainPairView& in, GrainRange range);
/// Restitution where a lane has a speed.
void bounce_pairs(const GrainPairView& in, GrainRange range, GrainWork& work);

}  // namespace tumble
