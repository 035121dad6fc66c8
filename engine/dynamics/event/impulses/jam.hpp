#pragma once
#include "engine/dynamics/event/impulses/impact_law.hpp"

namespace tumble {

/// Impulses at sliding points without a collision (Painlevé 1895; Lecornu 1905; Génot & Brogliato
/// 1999; Coutinho 2013 §14.3). Where the friction that a normal force causes presses the surfaces
/// together faster than the normal force separates them, a larger force makes it worse, and no
/// finite force may be in balance. Slip is then stopped at once, at one such point after the other,
/// by Routh's process from a negligible approach speed without restitution.
///
/// Returns the number of points at which an impulse acted; `report.impulses` and the velocities of
/// the blocks contain the effect. Points that approach afterwards are left to a law of impacts.
int resolve_jams(std::span<DofBlock> blocks, std::span<const ImpactPoint> points,
                 ImpactReport& report, const Articulation& joints = {});

/// The same where several points jam together though none does by itself, as for a drawer that
/// slides askew: impulses at all closed points at once, in Coulomb's cones against the slip
/// afterwards (implicit, as in a step of Moreau's method), over a negligible time and without
/// restitution. `accelerations` are those of B's points relative to A's without forces at the
/// points, world axes [m/s2]. Where finite sliding forces exist the impulses are those forces times
/// that time, and thus negligible.
///
/// Returns the number of points whose slip changed by more than a negligible amount; 0, with
/// nothing changed, if there are none or no solver answers.
int resolve_common_jam(std::span<DofBlock> blocks, std::span<const ImpactPoint> points,
                       std::span<const Vec3> accelerations, ImpactReport& report,
                       const Articulation& joints = {});

}  // namespace tumble
