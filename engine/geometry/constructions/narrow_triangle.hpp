#pragma once
#include "engine/math/types.hpp"

#include <array>
#include <optional>

/// What needs the normal of a triangle that is a sliver or a needle: the cross product of its sides
/// keeps few digits in double, so it is computed with twice as many.
namespace tumble {

/// The areas opposite each corner of the projection of p on the triangle's plane, up to a common
/// positive factor, each to nearly full precision: all positive where p projects inside. Zero for a
/// triangle without area.
Vec3 narrow_triangle_weights(const Vec3& p, const std::array<Vec3, 3>& t);

/// Where the segment from s0 to s1 passes through the triangle, in [0, 1]; nothing when it misses,
/// lies in the plane, or the triangle has no area.
std::optional<double> narrow_triangle_crossing(const Vec3& s0, const Vec3& s1,
                                               const std::array<Vec3, 3>& t);

}  // namespace tumble
