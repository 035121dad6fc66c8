#pragma once
#include "engine/dynamics/contact/surface/element_jets.hpp"

namespace tumble {

/// Gap of a cone (ElementKind::cone) and a point, line, circle (the disc inside it), ellipsoid or
/// cone; A or B or both are cones. Every normal n of a cone makes the same angle with its axis u,
/// n.u = -taper, and the support height of the cone along such a normal is n.o + r, with o and r
/// the centre and radius of any ball that it envelops. So the gap is the maximum of the separation
/// n.(o_B - o_A) - h_A(n) - h_B(-n) over the normals of the cone. With a point the normals form a
/// circle, and the best one lies in the plane of point and axis. With a line or another cone two
/// normals are possible, one on either side. With a circle or an ellipsoid the best one is found by
/// Newton's method in the angle about the axis, then repeated in Taylor arithmetic with the slope
/// at the solution, where each pass makes one more derivative exact (Griewank & Walther 2008,
/// 15.2). Irregular where a point is on the axis, where the axes of the two are parallel, and where
/// no normal near `towards_b` is the best one.
template <class Number>
ElementMeeting<Number> cone_gap(const MovingElement<Number>& a, const MovingElement<Number>& b,
                                const Vec3& towards_b);

}  // namespace tumble
