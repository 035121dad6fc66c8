#pragma once
#include "engine/math/types.hpp"

#include <limits>
#include <span>

namespace tumble {

/// True only if the convex hulls of two sets of points (neither empty) are more than `reach` apart:
/// answered by a direction along which their shadows are, found by the iteration of Gilbert,
/// Johnson & Keerthi (1988). Hulls that are closer, or so nearly that far apart that rounding could
/// decide (1e-12 of their size), give false. Costs grow with the number of points: made for a few
/// dozen.
bool hulls_apart(std::span<const Vec3> a, std::span<const Vec3> b, double reach);

/// Bounds of the distance of two hulls [m].
struct DistanceBracket {
  double lower = 0, upper = 0;
};

/// The distance of the two hulls between certain bounds, which agree up to rounding unless the
/// iteration stalls. It stops early when the lower bound exceeds `enough` or the upper one does
/// not; never for a NaN.
DistanceBracket hull_distance(std::span<const Vec3> a, std::span<const Vec3> b,
                              double enough = std::numeric_limits<double>::quiet_NaN());

}  // namespace tumble
