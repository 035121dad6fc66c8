#pragma once
#include "engine/collision/gjk/simplex.hpp"

#include <algorithm>
#include <cmath>

/// Corners, sides and faces of a simplex, for the inner loops of GJK: always inlined, so that the
/// nearest point stays in registers.
namespace tumble {

/// The corners that span the nearest point, and the point.
struct SimplexSide {
  int corner[3];
  int count = 0;
  NearestPoint at{{}, std::numeric_limits<double>::infinity(), {}, 0};

  /// Sorts corners in ascending order, so that corners that are kept move to lower indices.
  [[gnu::always_inline]] inline void sort() {
    if (count == 3 && corner[0] > corner[1]) std::swap(corner[0], corner[1]);
    if (count == 3 && corner[1] > corner[2]) std::swap(corner[1], corner[2]);
    if (count > 1 && corner[0] > corner[1]) std::swap(corner[0], corner[1]);
  }
};

[[gnu::always_inline]] inline void on_corner(const Plain3& a, int ia, SimplexSide& s) {
  s.corner[0] = ia;
  s.count = 1;
  s.at = {a, a.squared(), a, 0};
}

/// Nearest point on the segment from a, the new corner, to b.
[[gnu::always_inline]] inline void on_segment(const Plain3& a, int ia, const Plain3& b, int ib,
                                              SimplexSide& s) {
  const Plain3 ab = b - a;
  const double along = -a.dot(ab), length2 = ab.squared();
  if (along <= 0) return on_corner(a, ia, s);
  if (along >= length2) return on_corner(b, ib, s);
  s.at.along = length2 * a + along * ab;
  s.at.v = a + (along / length2) * ab;
  s.at.vv = s.at.v.squared();
  // the rounding error along the segment would tilt the support plane
  if (s.at.vv < 1e-4 * length2) {
    s.at.v = s.at.v - (s.at.v.dot(ab) / length2) * ab;
    s.at.vv = s.at.v.squared();
    s.at.along = s.at.v;
  }
  s.corner[0] = ib, s.corner[1] = ia;
  s.count = 2;
}

/// Nearest point on the triangle with normal n = ab x ac, given that it is not in the interior of
/// side bc.
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

/// Volumes (six times that of the tetrahedron) below this cannot be told from zero. The argument is
/// the squared greatest distance of a corner from the origin.
[[gnu::always_inline]] inline double doubtful_volume(double size2) {
  return 1e-14 * size2 * std::sqrt(size2);
}

/// Nearest point on the tetrahedron with corners 3 (a, the new one), 2 (b), 1 (c) and 0 (d), on a
/// side that contains a.
[[gnu::always_inline]] inline Reduction on_tetrahedron(const Plain3& a, const Plain3& b,
                                                       const Plain3& c, const Plain3& d,
                                                       SimplexSide& s) {
  const Plain3 ab = b - a, ac = c - a, ad = d - a;
  const Plain3 abc = ab.cross(ac), acd = ac.cross(ad), adb = ad.cross(ab);
  const double volume = abc.dot(ad);
  const double side = volume > 0 ? 1 : -1;
  // the origin's heights over the sides that meet at a, positive outside
  const double over_abc = side * abc.dot(a), over_acd = side * acd.dot(a),
               over_adb = side * adb.dot(a);
  const double doubt = doubtful_volume(
      std::max(std::max(a.squared(), b.squared()), std::max(c.squared(), d.squared())));
  const bool flat = !(std::abs(volume) > doubt);
  const double highest = std::max(over_abc, std::max(over_acd, over_adb));
  if (!flat && highest <= doubt) return highest < -doubt ? Reduction::inside : Reduction::unclear;
  const auto offer = [&](int ib, const Plain3& p, int ic, const Plain3& q, const Plain3& n)
      __attribute__((always_inline)) {
    SimplexSide other;
    on_triangle(a, 3, p, ib, q, ic, n, other);
    if (other.at.vv < s.at.vv) s = other;
  };
  if (flat || over_abc > 0) offer(2, b, 1, c, abc);
  if (flat || over_acd > 0) offer(1, c, 0, d, acd);
  if (flat || over_adb > 0) offer(0, d, 2, b, adb);
  if (flat) {
    // No point of the tetrahedron is farther from these three sides than its height over the
    // largest.
    const double side2 = std::max(abc.squared(), std::max(acd.squared(), adb.squared()));
    if (!(s.at.vv * side2 > 4 * doubt * doubt)) return Reduction::unclear;
  }
  s.sort();
  return Reduction::outside;
}

/// Sets the weights of v, which all corners span. False if they miss it by more than the tolerance.
inline bool weigh_in_double(Simplex& s, const Plain3& v, double tolerance) {
  const auto point = [&](size_t i) -> const Plain3& { return s.points[i].w; };
  s.weights = {1, 0, 0, 0};
  if (s.count == 2) {
    const Plain3 ab = point(1) - point(0);
    const double length2 = ab.squared();
    if (length2 > 0) {
      const double t = std::min(std::max(-point(0).dot(ab) / length2, 0.0), 1.0);
      s.weights = {1 - t, t, 0, 0};
    }
  } else if (s.count == 3) {
    const Plain3 &p = point(0), &q = point(1), &r = point(2);
    const Plain3 pq = q - p, pr = r - p, n = pq.cross(pr);
    const double n2 = n.squared();
    if (n2 > 0) {
      // areas of the triangles of the origin's projection with two corners, relative to the whole
      const Plain3 o = -p;
      double wq = o.cross(pr).dot(n) / n2, wr = pq.cross(o).dot(n) / n2;
      wq = std::min(std::max(wq, 0.0), 1.0);
      wr = std::min(std::max(wr, 0.0), 1.0 - wq);
      s.weights = {1 - wq - wr, wq, wr, 0};
    }
  } else if (s.count == 4) {
    const Plain3 &p = point(0), &q = point(1), &r = point(2), &t = point(3);
    const double v0 = q.dot(r.cross(t)), v1 = -p.dot(r.cross(t)), v2 = p.dot(q.cross(t)),
                 v3 = -p.dot(q.cross(r)), sum = v0 + v1 + v2 + v3;
    if (sum != 0) s.weights = {v0 / sum, v1 / sum, v2 / sum, v3 / sum};
  }
  return (s.nearest() - v).squared() <= tolerance * tolerance;
}

}  // namespace tumble
