#pragma once
#include "engine/math/types.hpp"

#include <cmath>
#include <limits>

namespace tumble {

/// The unit quaternion along `q`: `q` itself, bit by bit, if it is a unit quaternion up to
/// rounding. Normalising it again would change the last bit in one of fifteen cases, so that a pose
/// read from a world and written back would differ.
inline Quat unit(const Quat& q) {
  // Normalising leaves |q|^2 within 4 rounding errors of 1: two each of the length and the
  // quotient.
  constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
  return std::abs(q.squaredNorm() - 1) <= rounding ? q : q.normalized();
}

}  // namespace tumble
