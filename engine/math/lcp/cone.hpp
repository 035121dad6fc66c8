#pragma once
#include "engine/math/lcp/problem.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble::lcp {

/// The point nearest to t in the section of the group's cone at axial value a: a disc or square of
/// half-width slope a (a point if a <= 0). For sliding groups the prescribed point, for any t.
inline std::array<double, 2> nearest_lateral(const ConeGroup& g, double a,
                                             std::array<double, 2> t) {
  const double radius = g.slope * std::max(a, 0.0);
  if (g.mode == ConeMode::sliding) return {-radius * g.direction[0], -radius * g.direction[1]};
  if (g.shape == ConeShape::pyramid)
    return {std::clamp(t[0], -radius, radius), std::clamp(t[1], -radius, radius)};
  const double length = std::sqrt(t[0] * t[0] + t[1] * t[1]);
  if (length <= radius) return t;
  const double f = radius / length;
  return {f * t[0], f * t[1]};
}

}  // namespace tumble::lcp
