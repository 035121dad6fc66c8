#pragma once
#include "engine/collision/fitting/primitive_kinds.hpp"

#include <span>

namespace tumble {

/// Root mean square of the distances of points from a primitive's surface [m].
double surface_misfit(const PrimitiveKind& kind, const PrimitiveGuess& guess,
                      std::span<const Vec3> points);

/// The primitive near `guess` whose surface has the least mean square distance from the points:
/// Levenberg-Marquardt (Marquardt 1963) over centre, rotation and sizes, with derivatives by finite
/// differences. `scale` [m] is the size of the whole.
PrimitiveGuess fit_least_squares(const PrimitiveKind& kind, PrimitiveGuess guess,
                                 std::span<const Vec3> points, double scale);

}  // namespace tumble
