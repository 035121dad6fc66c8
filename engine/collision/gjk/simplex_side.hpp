#pragma once
#include "engine/collision/gjk/simplex.hpp"

/// Corners, sides and faces of a simplex, for the loops that go over them: inlined by force, so
/// that the point they find stays in registers.
namespace tumble {

/// Corners that carry the nearest point, and the point.
struct SimplexSide {
  int corner[3];
  int count = 0;
  NearestPoint at{{}, std::numeric_limits<double>::infinity(), {}, 0};
};

[[gnu::always_inline]] inline void on_corner(const Plain3& a, int ia, SimplexSide& s) {
  s.corner[0] = ia;
  s.count = 1;
  s.at = {a, a.squared(), a, 0};
}

/// On the segment from a, which is new, to b.
[[gnu::always_inline]] inline void on_segment(const Plain3& a, int ia, const Plain3& b, int ib,
                                              SimplexSide& s) {
  const Plain3 ab = b - a;
  const double along = -a.dot(ab), length2 = ab.squared();
  if (along <= 0) return on_corner(a, ia, s);
  if (along >= length2) return on_corner(b, ib, s);
  s.at.along = length2 * a + along * ab;
  s.at.v = a + (along / length2) * ab;
  s.at.vv = s.at.v.squared();
  // what cancellation left along the segment would tilt the support plane
  if (s.at.vv < 1e-4 * length2) {
    s.at.v = s.at.v - (s.at.v.dot(ab) / length2) * ab;
    s.at.vv = s.at.v.squared();
    s.at.along = s.at.v;
  }
  s.corner[0] = ib, s.corner[1] = ia;
  s.count = 2;
}

/// On the triangle with normal n = ab x ac, but not on its side bc alone.
[[gnu::always_inline]] inline void on_triangle(const Plain3& a, int ia, const Plain3& b, int ib,
                                               const Plain3& c, int ic, const Plain3& n,
                                               SimplexSide& s) {
  const Plain3 ab = b - a, ac = c - a;
  const bool beyond_ab = ab.cross(n).dot(a) < 0, beyond_ac = n.cross(ac).dot(a) < 0;
  const double n2 = n.squared();
  if (!beyond_ab && !beyond_ac && n2 > 0) {
    const double height = n.dot(a);
    s.at.along = height < 0 ? -n : n;
    s.at.v = (height / n2) * n;
    s.at.vv = height * height / n2;
    s.corner[0] = ic, s.corner[1] = ib, s.corner[2] = ia;
    s.count = 3;
    return;
  }
  if (!beyond_ac) return on_segment(a, ia, b, ib, s);
  on_segment(a, ia, c, ic, s);
  if (!beyond_ab) return;
  SimplexSide other;
  on_segment(a, ia, b, ib, other);
  if (other.at.vv < s.at.vv) s = other;
}

}  // namespace tumble
