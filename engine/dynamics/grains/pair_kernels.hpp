#pragma once
#include "engine/dynamics/grains/grain_bundles.hpp"

namespace tumble {

/// The arrays that the kernels for pairs work on.
struct GrainPairView {
  GrainPoint* points;
  GrainMover* movers;
  GrainBundle* bundles;
  GrainTurning* turnings;  ///< by bundle, or null
  GrainBounce* bounces;    ///< by bundle, or null
};

/// Work in a part, by lane, to be summed at its end: of normal impulses, and of friction and
/// torques [J].
struct GrainWork {
  alignas(64) std::array<double, grain_lanes> lost{}, rubbed{};
};

// The inner loops over bundles, on the widest vectors of the machine. Lanes are independent and
// nothing is fused or approximated, so that all machines give the same bits. Each function
// processes a range of bundles in order.

/// Updates directions, gaps and contact positions to the present positions of grains.
void follow_pairs(const GrainPairView& in, GrainRange range);
/// Applies the impulses of the previous sub-step, rotated into the present tangent planes.
void warm_start_pairs(const GrainPairView& in, GrainRange range, GrainWork& work);
/// One sweep: rolling and torsional friction, friction, normals; if `follows`, at the present
/// positions.
void sweep_pairs(const GrainPairView& in, GrainRange range, double inverse_hs, bool follows,
                 GrainWork& work);
/// Moves overlapping grains apart without changing velocities: unconverged sweeps would turn such
/// velocities into bouncing.
void part_overlapping_pairs(const GrainPairView& in, GrainRange range);
/// Applies restitution in lanes that have a restitution speed.
void bounce_pairs(const GrainPairView& in, GrainRange range, GrainWork& work);

}  // namespace tumble
