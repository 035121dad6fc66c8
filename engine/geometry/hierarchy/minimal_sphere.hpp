#pragma once
#include "engine/geometry/primitive_tests/shapes.hpp"

#include <span>

namespace tumble {

/// The smallest sphere that contains all points (at least one), to 1e-10 of its radius; the radius
/// is the distance of the furthest point from the centre, so that it contains them exactly as
/// computed. Welzl's problem ("Smallest enclosing disks (balls and ellipsoids)", 1991), solved by
/// his basis computation with the furthest point as pivot (Gaertner, "Fast and Robust Smallest
/// Enclosing Balls", 1999): a basis of at most four points, whose sphere grows until no point is
/// outside.
Sphere minimal_sphere(std::span<const Vec3> points);

}  // namespace tumble
