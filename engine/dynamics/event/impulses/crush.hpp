#pragma once
#include "engine/dynamics/event/impulses/impact_law.hpp"

#include <optional>

namespace tumble {

/// Proof that bodies which cannot yield press others together.
struct Crush {
  /// By point: the impulse of the proof, relative to the greatest one [-]
  std::vector<double> shares;
  /// Work of the approach velocities against these impulses, per unit of the greatest one [m/s];
  /// for two plates that close in on a body with equal impulses, their closing speed.
  double speed = 0;
  bool by_friction = false;  ///< without friction there would be impulses that resolve the contacts
};

/// Proof that no impulses satisfy the contact conditions, as where immovable bodies or their moving
/// surfaces close in, and what lies between cannot escape, for want of room or because of friction.
/// The proof is a set of impulses in the friction cones that cancel on everything that can move,
/// while the approach velocities work against them: impulses of any size stop nothing (lemma of
/// Farkas 1902, for cones). It is found as the residual of the velocities at the points nearest to
/// the dual cones. Returns nothing where there is no such set; then impulses that satisfy all
/// conditions exist (Acary, Cadoux, Lemaréchal & Malick 2011).
std::optional<Crush> find_crush(std::span<const DofBlock> blocks,
                                std::span<const ImpactPoint> points,
                                const Articulation& joints = {});

}  // namespace tumble
