#pragma once
#include "engine/dynamics/contact/impulses/impact_law.hpp"

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

}  // namespace tumble
