#pragma once
#include "engine/dynamics/contact/surface/element_jets.hpp"

namespace tumble {

/// An ellipsoid and a plane: the lowest point of the ellipsoid is at the height of its centre less
/// sqrt(n^T S n), where n is the plane's normal and S the sum of a a^T over the semi-axes a.
template <class Number>
ElementMeeting<Number> ellipsoid_plane(const MovingElement<Number>& ellipsoid,
                                       const MovingElement<Number>& plane);

/// An ellipsoid and a point, line, circle (the disc inside it) or ellipsoid: the maximum of the
/// separation f(n) = n.(c_B - c_A) - h_A(n) - h_B(-n) over all unit directions n, or over those
/// perpendicular to a line, where h(n) = sqrt(n^T S n) + r is the support height of a side over its
/// centre. This holds for separated shapes as well as for slightly overlapping ones, and is as
/// accurate at gap 0. Found by Newton's method from `towards_b`, then repeated in Taylor arithmetic
/// with the matrix at the solution, where each pass makes one more derivative exact (Griewank &
/// Walther 2008, 15.2). Irregular where no direction near `towards_b` is the best one.
template <class Number>
ElementMeeting<Number> ellipsoid_curve(const MovingElement<Number>& a,
                                       const MovingElement<Number>& b, const Vec3& towards_b);

}  // namespace tumble
