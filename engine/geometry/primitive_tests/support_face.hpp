#pragma once
#include "engine/geometry/primitive_tests/sum_set.hpp"

#include <limits>

namespace tumble {

/// The corners of a shape furthest along a direction, in order around it: one to four points.
/// TriangleCorners within 1e-13 of the shape's size of the furthest count.
struct SupportFace {
  std::array<Vec3, 4> corners;
  int count = 0;
};
SupportFace support_face(const Segment& segment, const Vec3& direction);
SupportFace support_face(const Triangle3& triangle, const Vec3& direction);
/// Of a box whose three half axes are not zero and lie in one plane across the direction, the
/// parallelogram of the first two.
SupportFace support_face(const OrientedBox& box, const Vec3& direction);

/// The contact along a direction of penetration: nearest points of face a moved by -depth along the
/// normal, and of face b.
PrimitiveContact contact_between(const SupportFace& a, const SupportFace& b,
                                 const Penetration& penetration);

/// The contact of two intersecting shapes, each a segment, triangle or oriented box: shortest
/// translation that parts them, and a point of either that is then common. Of translations equally
/// short up to rounding the one whose points are: faces that are all but parallel have others,
/// beyond the end of the face.
template <class A, class B>
PrimitiveContact deepest_contact(const A& a, const B& b, const SumSet& set) {
  PrimitiveContact best;
  double least = std::numeric_limits<double>::infinity();
  for (const Penetration& p : penetrations(set)) {
    const PrimitiveContact c =
        contact_between(support_face(a, p.normal), support_face(b, -p.normal), p);
    const double gap = (c.on_a - c.on_b - c.depth * c.normal).norm();
    const double rounding = 1e-14 * (c.on_a.norm() + c.on_b.norm() + c.depth);
    if (!(gap < least)) continue;
    best = c;
    least = gap;
    if (gap <= rounding) break;
  }
  return best;
}

}  // namespace tumble
