#pragma once
#include "engine/math/types.hpp"

#include <cmath>
#include <limits>

namespace tumble {

/// The unit quaternion along `q`: `q` itself, bit by bit, where it is one as nearly as rounding
/// lets it be. To normalise once more would move the last bit of one in fifteen, so that what was
/// taken out of a world and put back would not be where it was.
inline Quat unit(const Quat& q) {
  // Normalising leaves |q|^2 within 4 roundings of 1: two of the length's and quotient's each.
  constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
  return std::abs(q.squaredNorm() - 1) <= rounding ? q : q.normalized();
}

}  // namespace tumble
