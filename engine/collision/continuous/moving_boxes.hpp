#pragma once
#include "engine/collision/motion.hpp"
#include "engine/core/result.hpp"

#include <optional>

namespace tumble {

/// A box about its frame's origin, moving rigidly.
struct MovingBox {
  Vec3 half_extents = Vec3::Zero();  ///< [m], >= 0
  Motion motion;
};

/// The first contact of two moving boxes. Before t_lo they are apart: proven, rounding included.
/// When `certain` they are proven to overlap at t_hi, so that the first contact is in [t_lo, t_hi];
/// else they come nearer than 1e-12 of the size (extents and way) at t_lo, too little to say
/// whether they touch, and t_hi is when they are apart again, or the end.
struct MovingBoxContact {
  double t_lo = 0, t_hi = 0;  ///< [s]
  bool certain = false;
  Vec3 normal = Vec3::UnitY();  ///< unit, world, from A to B: the axis along which they were apart
  /// 0..2 faces of A, 3..5 faces of B, 6 + 3 i + j edges along axis i of A and axis j of B.
  int axis = 0;
};

/// When two boxes that both turn and travel (Coutinho 2013 §2.5.17) first touch; nothing when they
/// never do. Marches by steps that are proven free: a separating axis (Gottschalk, Lin & Manocha
/// 1996) that turns linearly over the step separates the chords of all corners, its gap being
/// quadratic in time, by more than their arcs depart from the chords, h^2/8 omega^2 lever. No
/// contact is missed; after 4096 steps what is left counts as contact, not certain.
///
/// Both motions must span the same interval. Refuses non-finite values and negative extents.
Result<std::optional<MovingBoxContact>> moving_boxes_contact(const MovingBox& a,
                                                             const MovingBox& b);

}  // namespace tumble
