#pragma once
#include "engine/math/types.hpp"

#include <limits>
#include <span>

namespace tumble {

/// True only if the convex hulls of two sets of points (neither empty) are more than `reach` apart:
/// decided by a direction along which their projections are, found by the iteration of Gilbert,
/// Johnson & Keerthi (1988). False for hulls that are closer, or so nearly that far apart that
/// rounding could decide (1e-12 of their size). The cost grows with the number of points: meant for
/// a few dozen.
bool hulls_apart(std::span<const Vec3> a, std::span<const Vec3> b, double reach);

/// Bounds of the distance of two hulls [m].
struct DistanceBracket {
  double lower = 0, upper = 0;
};

/// Lower and upper bounds of the distance of the two hulls, equal up to rounding unless the
/// iteration stalls. It stops early when the lower bound exceeds `enough` or the upper one does
/// not; never for a NaN.
DistanceBracket hull_distance(std::span<const Vec3> a, std::span<const Vec3> b,
                              double enough = std::numeric_limits<double>::quiet_NaN());

}  // namespace tumble
