#pragma once
#include "engine/dynamics/event/impulses/impact_law.hpp"

namespace tumble {

/// One collision after the other, the fastest first, each by `energetic_impact`, until no point
/// approaches: propagation of impulses (Coutinho 2013 §3.5.1, §4.11.1; Ivanov 1995). Of two equally
/// fast points the one of lower index comes first, so that symmetric collisions need not stay
/// symmetric. Where this has not ended after 1000 collisions per point, all points that still
/// approach are stopped at once without restitution; where that has no solution, an approach of up
/// to a thousandth of the fastest velocity is left.
ImpactReport sequential_impacts(std::span<DofBlock> blocks, std::span<const ImpactPoint> points,
                                const Articulation& joints = {});

/// All at once, each approaching point to leave at no less than restitution times its approach
/// (Coutinho 2013 §3.5.2, §4.11.2; Moreau 1988). Where energy would grow, restitution is scaled
/// down (ImpactReport::restitution_scale).
ImpactReport simultaneous_newton(std::span<DofBlock> blocks, std::span<const ImpactPoint> points,
                                 const Articulation& joints = {});

/// All at once in two phases: compression until no point approaches; then every point returns
/// restitution times its normal impulse of compression, and points that approach because of that
/// are stopped without restitution (Pfeiffer & Glocker 1996; Anitescu & Potra 1997). Energy may
/// therefore be lost even at restitution 1.
ImpactReport simultaneous_poisson(std::span<DofBlock> blocks, std::span<const ImpactPoint> points,
                                  const Articulation& joints = {});

/// The approaching points at once, as `simultaneous_newton` does, then those that approach after
/// that, and so on: conserves energy (restitution 1, no friction), momentum and symmetry, and gives
/// the behaviour of Newton's cradle (Smith, Kaufman, Vouga, Tamstorf & Grinspun, "Reflections on
/// simultaneous impact", 2012). In a closed chain the approach travels round and decays slowly: all
/// points are stopped at once without restitution after 50 rounds if they could rebound no faster
/// than a thousandth of the fastest velocity (a millionth of the energy), after 1000 rounds in any
/// case, and at once if no point has restitution.
ImpactReport reflections(std::span<DofBlock> blocks, std::span<const ImpactPoint> points,
                         const Articulation& joints = {});

}  // namespace tumble
