#pragma once
#include "engine/math/types.hpp"

namespace tumble {

/// Exact sign of the area of triangle a b c in the plane: 1 counter-clockwise, -1 clockwise,
/// 0 collinear. A floating-point filter (Shewchuk 1997) decides nearly always, exact expansions
/// otherwise.
int orientation(const Vec2& a, const Vec2& b, const Vec2& c);

/// Exact sign of (b - a) x (c - a) . (d - a): 1 when d lies above the plane of a b c (on the side
/// from which they run counter-clockwise), -1 below, 0 on it. Exact while coordinates and their
/// products neither overflow nor underflow: magnitudes of 1e-90 to 1e90.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Exactly collinear (or not all different).
bool collinear(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace tumble
