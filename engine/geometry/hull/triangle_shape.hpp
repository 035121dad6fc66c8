#pragma once
#include "engine/math/types.hpp"

namespace tumble {

/// What a hull needs to know of a triangle that may be very thin.
struct TriangleShape {
  Vec3 normal;     ///< unit, on the side from which a b c run counter-clockwise; zero without area
  double area2;    ///< twice the area [m^2]
  double longest;  ///< its longest side [m]
  double uncertain;  ///< bound of the distance of `normal` from the exact one [-]
};

/// The shape of a b c. When rounding may have turned the normal by more than `good_enough` [-], it
/// is taken from more exact products, so that however thin the triangle is, its plane is right.
/// Coordinates as for predicates/orientation.
TriangleShape triangle_shape(const Vec3& a, const Vec3& b, const Vec3& c, double good_enough);

/// A bound from above, by rounding only, of the distance of `p` from segment a b [m].
double distance_to_segment(const Vec3& a, const Vec3& b, const Vec3& p);

/// The same for triangle a b c with unit normal `normal` and p at `height` over its plane [m].
double distance_to_triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal,
                            double height, const Vec3& p);

}  // namespace tumble
