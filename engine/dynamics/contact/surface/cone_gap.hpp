#pragma once
#include "engine/dynamics/contact/surface/element_jets.hpp"

namespace tumble {

/// A cone (ElementKind::cone) and a point, line, circle (the disc inside it), ellipsoid or cone; A
/// or B or both are cones. All normals of a cone lean against its axis u by n.u = -taper, and along
/// such a normal the cone reaches n.o + r, whichever ball of its centre line is asked. So the gap
/// is the greatest separation n.(o_B - o_A) - h_A(n) - h_B(-n) over the normals that the cone has:
/// with a point these are a circle, and the best one is in the plane of point and axis; with a line
/// or another cone there are two, one on either side; with a circle or an ellipsoid the best one is
/// found by Newton's method in the angle about the axis, and once more in Taylor arithmetic with
/// the slope of the solution, where each pass makes one more derivative exact (Griewank & Walther
/// 2008, 15.2). Not regular where a point is on the axis, where lines of the two are parallel, and
/// where no normal near `towards_b` is the best one.
template <class Number>
ElementMeeting<Number> cone_gap(const MovingElement<Number>& a, const MovingElement<Number>& b,
                                const Vec3& towards_b);

}  // namespace tumble
