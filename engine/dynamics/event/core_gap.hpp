#pragma once
#include "engine/collision/convex_pairs/convex_convex.hpp"

namespace tumble {

/// Two convex cores in one frame.
struct CorePair {
  PlacedCore a, b;
  double size;  ///< of the smaller one [m]

  /// Separation along n: B's least height less A's greatest [m].
  double separation(const Vec3& n) const { return n.dot(b.support(-n) - a.support(n)); }
};

/// The greatest separation of two cores along any direction; not `within` where it is more than
/// `farthest` [m]. See pair_gap() for the method and for `towards_b`.
CoreContact core_gap(const CorePair& cores, double farthest, const Vec3& towards_b);

}  // namespace tumble
