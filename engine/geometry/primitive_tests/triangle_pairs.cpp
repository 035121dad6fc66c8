#include "engine/geometry/primitive_tests/triangle_pairs.hpp"

#include "engine/geometry/predicates/orientation.hpp"
#include "engine/geometry/primitive_tests/support_face.hpp"

#include <utility>

// Two triangles intersect exactly if a side of one intersects the other, or, when coplanar, if one
// contains the other. Each part is decided by exact orientations. Coplanar cases are projected
// along a coordinate axis for which the triangle keeps an area, which does not change the answer.
namespace tumble {
namespace {

using Triangle2 = std::array<Vec2, 3>;

Vec2 drop(const Vec3& p, int axis) {
  return {p[(axis + 1) % 3], p[(axis + 2) % 3]};
}

/// A coordinate axis along which the triangle's projection has area; -1 if it has none at all.
int shadow_axis(const Triangle3& t) {
  for (int axis = 0; axis < 3; ++axis) {
    if (orientation(drop(t[0], axis), drop(t[1], axis), drop(t[2], axis)) != 0) return axis;
  }
  return -1;
}

bool between(double x, double a, double b) {
  return (a <= x && x <= b) || (b <= x && x <= a);
}

/// Whether p is on segment a-b, in the plane.
bool on_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  return orientation(a, b, p) == 0 && between(p.x(), a.x(), b.x()) && between(p.y(), a.y(), b.y());
}

bool segments_meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const int abc = orientation(a, b, c), abd = orientation(a, b, d);
  const int cda = orientation(c, d, a), cdb = orientation(c, d, b);
  if (abc * abd < 0 && cda * cdb < 0) return true;
  return on_segment(c, a, b) || on_segment(d, a, b) || on_segment(a, c, d) || on_segment(b, c, d);
}

bool holds(const Triangle2& t, const Vec2& p) {
  const int s0 = orientation(t[0], t[1], p), s1 = orientation(t[1], t[2], p),
            s2 = orientation(t[2], t[0], p);
  return (s0 >= 0 && s1 >= 0 && s2 >= 0) || (s0 <= 0 && s1 <= 0 && s2 <= 0);
}

bool on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  return collinear(a, b, p) && between(p.x(), a.x(), b.x()) && between(p.y(), a.y(), b.y()) &&
         between(p.z(), a.z(), b.z());
}

}  // namespace

bool segments_intersect(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  if (on_segment(c, a, b) || on_segment(d, a, b) || on_segment(a, c, d) || on_segment(b, c, d)) {
    return true;
  }
  if (orientation(a, b, c, d) != 0) return false;
  // Coplanar, with no end on the other segment: they can only cross properly, and then a b c has
  // area.
  const int axis = shadow_axis({a, b, c});
  if (axis < 0) return false;
  const Vec2 a2 = drop(a, axis), b2 = drop(b, axis), c2 = drop(c, axis), d2 = drop(d, axis);
  return orientation(a2, b2, c2) * orientation(a2, b2, d2) < 0 &&
         orientation(c2, d2, a2) * orientation(c2, d2, b2) < 0;
}

bool point_in_triangle(const Vec3& p, const Triangle3& t) {
  const int axis = shadow_axis(t);
  if (axis < 0) {
    return on_segment(p, t[0], t[1]) || on_segment(p, t[1], t[2]) || on_segment(p, t[2], t[0]);
  }
  return orientation(t[0], t[1], t[2], p) == 0 &&
         holds({drop(t[0], axis), drop(t[1], axis), drop(t[2], axis)}, drop(p, axis));
}

bool segment_triangle_intersect(const Vec3& p, const Vec3& q, const Triangle3& t) {
  const int axis = shadow_axis(t);
  if (axis < 0) {
    for (size_t k = 0; k < 3; ++k) {
      if (segments_intersect(p, q, t[k], t[(k + 1) % 3])) return true;
    }
    return false;
  }
  const int sp = orientation(t[0], t[1], t[2], p), sq = orientation(t[0], t[1], t[2], q);
  if (sp * sq > 0) return false;
  const Triangle2 flat{drop(t[0], axis), drop(t[1], axis), drop(t[2], axis)};
  if (sp == 0 && sq == 0) {
    const Vec2 p2 = drop(p, axis), q2 = drop(q, axis);
    if (holds(flat, p2) || holds(flat, q2)) return true;
    for (size_t k = 0; k < 3; ++k) {
      if (segments_meet(p2, q2, flat[k], flat[(k + 1) % 3])) return true;
    }
    return false;
  }
  if (sp == 0) return holds(flat, drop(p, axis));
  if (sq == 0) return holds(flat, drop(q, axis));
  // The line p-q passes all three sides with the same orientation.
  const int s0 = orientation(p, q, t[0], t[1]), s1 = orientation(p, q, t[1], t[2]),
            s2 = orientation(p, q, t[2], t[0]);
  return (s0 >= 0 && s1 >= 0 && s2 >= 0) || (s0 <= 0 && s1 <= 0 && s2 <= 0);
}

namespace {

/// For coplanar triangles and those without area: whether a side of one intersects the other.
bool sides_meet(const Triangle3& a, const Triangle3& b) {
  for (size_t k = 0; k < 3; ++k) {
    if (segment_triangle_intersect(a[k], a[(k + 1) % 3], b)) return true;
    if (segment_triangle_intersect(b[k], b[(k + 1) % 3], a)) return true;
  }
  return false;
}

/// Positions of the corners of `u` relative to the plane of `t`.
struct Sides {
  std::array<int, 3> s;

  Sides(const Triangle3& t, const Triangle3& u) {
    for (size_t k = 0; k < 3; ++k) s[k] = orientation(t[0], t[1], t[2], u[k]);
  }
  bool apart() const { return s[0] * s[1] > 0 && s[0] * s[2] > 0; }
  bool none() const { return s[0] == 0 && s[1] == 0 && s[2] == 0; }
};

/// The corner that is alone on its closed side of the other triangle's plane, and whether that side
/// is below. At least one corner is off the plane and not all are on one side.
struct Lead {
  size_t corner = 0;
  bool below = false;

  explicit Lead(const Sides& sides) {
    for (size_t k = 0; k < 3; ++k) {
      const int own = sides.s[k], next = sides.s[(k + 1) % 3], last = sides.s[(k + 2) % 3];
      const bool over = own >= 0 && next <= 0 && last <= 0 && (own > 0 || next * last > 0);
      const bool under = own <= 0 && next >= 0 && last >= 0 && (own < 0 || next * last > 0);
      if (!over && !under) continue;
      corner = k;
      below = under;
      return;
    }
  }
  Triangle3 first(const Triangle3& t) const {
    return {t[corner], t[(corner + 1) % 3], t[(corner + 2) % 3]};
  }
};

}  // namespace

bool triangles_intersect(const Triangle3& a, const Triangle3& b) {
  const Sides of_b(a, b);
  if (of_b.apart()) return false;
  const Sides of_a(b, a);
  if (of_a.apart()) return false;
  // Some corner is off the other's plane: that plane exists, so the other has area.
  if (of_a.none() || of_b.none()) return sides_meet(a, b);
  const Lead lead_a(of_a), lead_b(of_b);
  Triangle3 p = lead_a.first(a), q = lead_b.first(b);
  if (lead_a.below) std::swap(q[1], q[2]);
  if (lead_b.below) std::swap(p[1], p[2]);
  // On the common line of both planes each triangle covers an interval; they overlap if neither
  // begins after the other's end.
  return orientation(p[0], p[1], q[0], q[1]) <= 0 && orientation(p[0], p[2], q[2], q[0]) <= 0;
}

namespace {

/// Whether there are corners strictly on both sides of the plane.
bool strictly_both(const std::array<int, 3>& s) {
  const auto has = [&](int sign) { return s[0] == sign || s[1] == sign || s[2] == sign; };
  return has(1) && has(-1);
}

/// Whether no side of `t` has all of `u` on it or beyond it, i.e. no side of t separates the
/// interiors.
bool no_side_parts(const Triangle2& t, const Triangle2& u) {
  const int turn = orientation(t[0], t[1], t[2]);
  for (size_t k = 0; k < 3; ++k) {
    bool beyond = true;
    for (const Vec2& p : u) beyond = beyond && orientation(t[k], t[(k + 1) % 3], p) * turn <= 0;
    if (beyond) return false;
  }
  return true;
}

/// Whether two coplanar triangles with area have an area in common, by the separating axis theorem
/// for convex polygons.
bool areas_overlap(const Triangle3& a, const Triangle3& b) {
  const int axis = shadow_axis(a);
  if (axis < 0 || shadow_axis(b) < 0) return false;
  const Triangle2 flat_a{drop(a[0], axis), drop(a[1], axis), drop(a[2], axis)};
  const Triangle2 flat_b{drop(b[0], axis), drop(b[1], axis), drop(b[2], axis)};
  return no_side_parts(flat_a, flat_b) && no_side_parts(flat_b, flat_a);
}

}  // namespace

TriangleRelation triangle_relation(const Triangle3& a, const Triangle3& b) {
  if (!triangles_intersect(a, b)) return TriangleRelation::apart;
  const Sides of_b(a, b), of_a(b, a);
  if (of_a.none() && of_b.none()) {
    return areas_overlap(a, b) ? TriangleRelation::overlapping : TriangleRelation::touching;
  }
  if (!strictly_both(of_a.s) || !strictly_both(of_b.s)) return TriangleRelation::touching;
  // As in triangles_intersect, but with open intervals on the common line.
  const Lead lead_a(of_a), lead_b(of_b);
  Triangle3 p = lead_a.first(a), q = lead_b.first(b);
  if (lead_a.below) std::swap(q[1], q[2]);
  if (lead_b.below) std::swap(p[1], p[2]);
  const bool open =
      orientation(p[0], p[1], q[0], q[1]) < 0 && orientation(p[0], p[2], q[2], q[0]) < 0;
  return open ? TriangleRelation::crossing : TriangleRelation::touching;
}

std::optional<PrimitiveContact> triangle_triangle_contact(const Triangle3& a, const Triangle3& b) {
  if (!triangles_intersect(a, b)) return std::nullopt;
  return deepest_contact(a, b, difference(a, b));
}

std::optional<PrimitiveContact> segment_triangle_contact(const Segment& s, const Triangle3& t) {
  if (!segment_triangle_intersect(s.a, s.b, t)) return std::nullopt;
  return deepest_contact(s, t, difference(s, t));
}

std::optional<PrimitiveContact> edge_edge_contact(const Segment& a, const Segment& b) {
  if (!segments_intersect(a.a, a.b, b.a, b.b)) return std::nullopt;
  return deepest_contact(a, b, difference(a, b));
}

}  // namespace tumble
