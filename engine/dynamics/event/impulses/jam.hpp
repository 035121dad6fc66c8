#pragma once
#include "engine/dynamics/event/impulses/impact_law.hpp"

namespace tumble {

/// Impulses at sliding points without a collision (Painlevé 1895; Lecornu 1905; Génot & Brogliato
/// 1999; Coutinho 2013 §14.3): where the friction that goes with a normal force presses the
/// surfaces together faster than the normal force parts them, more force makes things worse, and it
/// may be that no finite one is in balance. Slip is then stopped at once: Routh's process from an
/// approach too small to matter, without restitution, at one such point after the other.
///
/// Returns the number of points at which an impulse acted; `report.impulses` and the velocities of
/// the blocks hold what it did. Points that approach after that are left to a law of impacts.
int resolve_jams(std::span<DofBlock> blocks, std::span<const ImpactPoint> points,
                 ImpactReport& report, const Articulation& joints = {});

/// The same where several points jam together though none does by itself, as a drawer that slides
/// askew: impulses at all closed points at once, in Coulomb's cones against the slip that is left
/// (implicit, as a step of Moreau's is), over a time too short to matter and without restitution.
/// `accelerations` are those of B's points, seen from A, that there would be without forces at the
/// points, world axes [m/s2]. Where sliding forces exist they are the answer, and as small as the
/// time is short.
///
/// Returns the number of points whose slip the impulses changed, not counting such; 0 with nothing
/// done where there are none or no solver answers.
int resolve_common_jam(std::span<DofBlock> blocks, std::span<const ImpactPoint> points,
                       std::span<const Vec3> accelerations, ImpactReport& report,
                       const Articulation& joints = {});

}  // namespace tumble
