#pragma once
#include "engine/dynamics/event/impulses/impact_law.hpp"

#include <optional>

namespace tumble {

/// Proof that bodies which cannot yield press others together.
struct Crush {
  std::vector<double> shares;  ///< by point: the impulse of the proof, of the greatest of them
  /// What the approach works against these [m/s]; of two plates that come together, each with all
  /// of its impulse, their speed.
  double speed = 0;
  bool by_friction = false;  ///< without it there would be a way out
};

/// Why there are no impulses: bodies that none can move come together, or are so carried by their
/// surfaces, and what lies between cannot get out of the way, for want of room or for friction. The
/// proof is a set of impulses in the friction cones that cancel on all that they move, and against
/// which the approach works: however great they are, they stop nothing (Farkas 1902, for cones).
/// It is what is left over where the velocities at the points are as near to the dual cones as can
/// be. Nothing where there is no such set; then there are impulses that satisfy all conditions
/// (Acary, Cadoux, Lemaréchal & Malick 2011).
std::optional<Crush> find_crush(std::span<const DofBlock> blocks,
                                std::span<const ImpactPoint> points,
                                const Articulation& joints = {});

}  // namespace tumble
