#pragma once
#include "engine/dynamics/grains/grain_bundles.hpp"

namespace tumble {

/// The arrays that the kernels for pairs work on.
struct GrainPairView {
  GrainShift* shifts;
  GrainRow* rows;
  GrainBundle* bundles;
  GrainTurning* turnings;  ///< by bundle, or null
  GrainBounce* bounces;    ///< by bundle, or null
};

/// Work in a part, by lane, to be summed at its end: of normal impulses, and of friction and
/// torques [J per unit of mass].
struct GrainWork {
  alignas(64) std::array<double, grain_lanes> lost{}, rubbed{};
};

/// Forces of pairs, in the lanes of a bundle.
struct GrainForcesView {
  GrainForces* forces;     ///< by pair
  const uint32_t* source;  ///< by lane: its pair
  GrainTurning* turning;   ///< or null
};

// The inner loops over bundles, on the widest vectors of the machine. Lanes are independent and
// nothing is fused or approximated, so that all machines give the same bits. Each function
// processes a range of bundles in order.

/// Sets the impulses of the lanes of a bundle: `unit` times the forces.
void read_forces(const GrainForcesView& from, float unit, GrainBundle& to);
/// Sets the forces: `unit` times the impulses.
void write_forces(const GrainForcesView& to, float unit, const GrainBundle& from);
/// Applies the impulses of the previous sub-step, rotated into the present tangent planes.
void warm_start_pairs(const GrainPairView& in, GrainRange range, GrainWork& work);
/// One sweep: rolling and torsional friction, friction, normals. If `follows`, each contact is
/// first brought to the present positions.
void sweep_pairs(const GrainPairView& in, GrainRange range, float inverse_hs, bool follows,
                 GrainWork& work);
/// Moves overlapping grains apart without changing velocities: unconverged sweeps would turn such
/// velocities into bouncing.
void part_overlapping_pairs(const GrainPairView& in, GrainRange range);
/// Applies restitution in lanes that have a restitution speed.
void bounce_pairs(const GrainPairView& in, GrainRange range, GrainWork& work);

}  // namespace tumble
