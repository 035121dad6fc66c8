#pragma once
#include "engine/math/types.hpp"

#include <array>

namespace tumble {

/// A point that moves in a straight line at constant speed from `start` at t = 0 to `end` at t = 1.
struct MovingPoint {
  Vec3 start = Vec3::Zero();  ///< [m]
  Vec3 end = Vec3::Zero();    ///< [m]

  Vec3 at(double t) const { return start + t * (end - start); }
};

using MovingEdge = std::array<MovingPoint, 2>;
using MovingTriangle = std::array<MovingPoint, 3>;

/// The first contact of two features A and B whose corners move linearly over t in [0, 1].
///
/// Before t_lo the two are further apart than the separation asked for: this is proven, rounding
/// included. When `certain`, the first contact in exact arithmetic is proven to lie in
/// [t_lo, t_hi]. Otherwise the distance at t_lo exceeds that separation by less than 1e-13 of the
/// size (the greatest distance of any two corners during the motion), too little to say whether
/// they meet, touch or pass: it is reported as contact, and t_hi is when they are apart again, or
/// certainly in contact, or 1.
struct MovingContact {
  double t_lo = 0, t_hi = 1;
  bool certain = false;
  /// Where, at t_lo. Vertex on face: weights of the second and third corner. Edge on edge:
  /// fractions along A and along B.
  Vec2 parameters = Vec2::Zero();
  Vec3 normal = Vec3::UnitY();  ///< unit, from A to B, as they were before the contact
};

}  // namespace tumble
