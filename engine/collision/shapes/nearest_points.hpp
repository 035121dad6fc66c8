#pragma once
#include "engine/math/types.hpp"

namespace tumble {

/// The point of a solid's surface nearest to a query point, in the solid's frame.
struct SurfacePoint {
  Vec3 x = Vec3::Zero();        ///< on the surface [m]
  Vec3 normal = Vec3::UnitY();  ///< unit, outward
  double distance = 0;          ///< negative inside [m]
};

// Closed forms for solids about the origin, exact up to rounding. If several points are equally
// near (for the centre of a ball), one of them is returned.
SurfacePoint nearest_on_ball(double radius, const Vec3& p);
/// All within `radius` of the segment of half length `half_height` along y.
SurfacePoint nearest_on_capsule(double half_height, double radius, const Vec3& p);
SurfacePoint nearest_on_box(const Vec3& half, const Vec3& p);
/// Along y.
SurfacePoint nearest_on_cylinder(double half_height, double radius, const Vec3& p);
/// For the solid sum (x_i / a_i)^2 <= 1. On the surface p - x is along the gradient, so that x_i =
/// a_i^2 p_i / (t + a_i^2), with t the largest root of sum (a_i p_i / (t + a_i^2))^2 = 1 (Eberly,
/// "Distance from a Point to an Ellipse, an Ellipsoid, or a Hyperellipsoid", 2013). Left of the
/// root the sum is above 1, decreasing and convex, so Newton's method from there converges
/// monotonically.
SurfacePoint nearest_on_ellipsoid(const Vec3& semi_axes, const Vec3& p);

}  // namespace tumble
