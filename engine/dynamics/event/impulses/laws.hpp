#pragma once
#include "engine/dynamics/event/impulses/impact_law.hpp"

namespace tumble {

/// One collision after the other, the fastest first, each by `energetic_impact`, until nothing
/// approaches: the propagation of impulses (Coutinho 2013 §3.5.1, §4.11.1; Ivanov 1995). Which of
/// two equally fast ones is first is a matter of order, so symmetric collisions need not stay
/// symmetric. Where it does not come to an end within 1000 collisions a point, what is left is
/// taken at once without restitution; where that has no answer, a thousandth of the fastest
/// velocity may be left of the approach.
ImpactReport sequential_impacts(std::span<DofBlock> blocks, std::span<const ImpactPoint> points,
                                const Articulation& joints = {});

/// All at once, each point that approaches to leave at least at restitution times its approach
/// (Coutinho 2013 §3.5.2, §4.11.2; Moreau 1988). Where energy would grow, restitution is scaled
/// down by the report's `restitution_scale`.
ImpactReport simultaneous_newton(std::span<DofBlock> blocks, std::span<const ImpactPoint> points,
                                 const Articulation& joints = {});

/// All at once in two phases: compression until nothing approaches, then every point gives back
/// restitution times its normal impulse of compression, and what this makes approach is stopped
/// without restitution (Pfeiffer & Glocker 1996; Anitescu & Potra 1997): so that restitution 1 may
/// lose energy.
ImpactReport simultaneous_poisson(std::span<DofBlock> blocks, std::span<const ImpactPoint> points,
                                  const Articulation& joints = {});

/// The approaching points at once, as `simultaneous_newton` does, then what approaches after that,
/// and so on: keeps energy (restitution 1, no friction), momentum and symmetry, and lets Newton's
/// cradle swing (Smith, Kaufman, Vouga, Tamstorf & Grinspun, "Reflections on simultaneous impact",
/// 2012). In a closed chain the approach runs round and round, and fades slowly: after 50 rounds
/// what restitution could give back no faster than a thousandth of the fastest velocity (a
/// millionth of the energy), or after 1000 rounds what is left, is taken at once without
/// restitution. So is all where nothing has any.
ImpactReport reflections(std::span<DofBlock> blocks, std::span<const ImpactPoint> points,
                         const Articulation& joints = {});

}  // namespace tumble
