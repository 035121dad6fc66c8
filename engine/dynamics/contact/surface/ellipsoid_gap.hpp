#pragma once
#include "engine/dynamics/contact/surface/element_jets.hpp"

namespace tumble {

/// An ellipsoid over a plane: its furthest point against the plane's normal n is at the centre's
/// height less sqrt(n^T S n), where S is the sum of a a^T over the semi-axes a.
template <class Number>
ElementMeeting<Number> ellipsoid_plane(const MovingElement<Number>& ellipsoid,
                                       const MovingElement<Number>& plane);

/// An ellipsoid and a point, line, circle (the disc inside it) or ellipsoid: the greatest
/// separation f(n) = n.(c_B - c_A) - h_A(n) - h_B(-n) along any unit direction, where h(n) =
/// sqrt(n^T S n) + r is the height of a side over its centre; across a line only. That holds as
/// well where the two are apart as where they overlap a little, and at gap 0 loses nothing. Found
/// by Newton's method from `towards_b` and once more in Taylor arithmetic with the matrix of the
/// solution, each pass makes one more derivative exact (Griewank & Walther 2008, 15.2). Not regular
/// where no direction near `towards_b` is the best one.
template <class Number>
ElementMeeting<Number> ellipsoid_curve(const MovingElement<Number>& a,
                                       const MovingElement<Number>& b, const Vec3& towards_b);

}  // namespace tumble
