#include "engine/collision/gjk/simplex_side.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

void keep_side(Simplex& simplex, SimplexSide& s) {
  // in ascending order, so that each corner moves down
  if (s.count == 3 && s.corner[0] > s.corner[1]) std::swap(s.corner[0], s.corner[1]);
  if (s.count == 3 && s.corner[1] > s.corner[2]) std::swap(s.corner[1], s.corner[2]);
  if (s.count > 1 && s.corner[0] > s.corner[1]) std::swap(s.corner[0], s.corner[1]);
  simplex.keep(s.corner, s.count);
}

/// Volumes (six times) below this cannot be told from zero.
double doubtful_volume(const Simplex& s) {
  double size2 = 0;
  for (const DifferencePoint& p : s.points) size2 = std::max(size2, p.w.squared());
  return 1e-14 * size2 * std::sqrt(size2);
}

/// On a triangle, all three sides looked at.
void on_whole_triangle(const Simplex& simplex, int ia, int ib, int ic, SimplexSide& s) {
  const Plain3 &a = simplex.points[size_t(ia)].w, &b = simplex.points[size_t(ib)].w,
               &c = simplex.points[size_t(ic)].w;
  const Plain3 bc = c - b, n = (b - a).cross(c - a);
  on_triangle(a, ia, b, ib, c, ic, n, s);
  if (!(bc.cross(n).dot(b) < 0)) return;
  SimplexSide other;
  on_segment(b, ib, c, ic, other);
  if (s.count == 3 || other.at.vv < s.at.vv) s = other;
}

void weigh_in_double(Simplex& s) {
  const auto point = [&](int i) -> const Plain3& { return s.points[size_t(i)].w; };
  s.weights = {1, 0, 0, 0};
  if (s.count == 2) {
    const Plain3 ab = point(1) - point(0);
    const double length2 = ab.squared();
    if (!(length2 > 0)) return;
    const double t = std::min(std::max(-point(0).dot(ab) / length2, 0.0), 1.0);
    s.weights = {1 - t, t, 0, 0};
  } else if (s.count == 3) {
    const Plain3 &p = point(0), &q = point(1), &r = point(2);
    const Plain3 pq = q - p, pr = r - p, n = pq.cross(pr);
    const double n2 = n.squared();
    if (!(n2 > 0)) return;
    // areas across the plane of what is left of the origin beyond each side
    const Plain3 o = -p;
    double wq = o.cross(pr).dot(n) / n2, wr = pq.cross(o).dot(n) / n2;
    wq = std::min(std::max(wq, 0.0), 1.0);
    wr = std::min(std::max(wr, 0.0), 1.0 - wq);
    s.weights = {1 - wq - wr, wq, wr, 0};
  } else if (s.count == 4) {
    const Plain3 &p = point(0), &q = point(1), &r = point(2), &t = point(3);
    const double v0 = q.dot(r.cross(t)), v1 = -p.dot(r.cross(t)), v2 = p.dot(q.cross(t)),
                 v3 = -p.dot(q.cross(r)), sum = v0 + v1 + v2 + v3;
    if (sum != 0) s.weights = {v0 / sum, v1 / sum, v2 / sum, v3 / sum};
  }
}

}  // namespace

Reduction reduce(Simplex& simplex, NearestPoint& v) {
  const auto point = [&](int i) -> const Plain3& { return simplex.points[size_t(i)].w; };
  SimplexSide s;
  if (simplex.count == 1) {
    on_corner(point(0), 0, s);
    v = s.at;
    return Reduction::outside;
  }
  if (simplex.count == 2) {
    on_segment(point(1), 1, point(0), 0, s);
  } else if (simplex.count == 3) {
    const Plain3 &a = point(2), &b = point(1), &c = point(0);
    on_triangle(a, 2, b, 1, c, 0, (b - a).cross(c - a), s);
  } else {
    const Plain3 &a = point(3), &b = point(2), &c = point(1), &d = point(0);
    const Plain3 ab = b - a, ac = c - a, ad = d - a;
    const Plain3 abc = ab.cross(ac), acd = ac.cross(ad), adb = ad.cross(ab);
    const double volume = abc.dot(ad);
    const double side = volume > 0 ? 1 : -1;
    // the origin's heights over the sides that meet at a, positive outside
    const double over_abc = side * abc.dot(a), over_acd = side * acd.dot(a),
                 over_adb = side * adb.dot(a);
    const double doubt = doubtful_volume(simplex);
    if (!(std::abs(volume) > doubt)) return Reduction::unclear;
    const double highest = std::max(over_abc, std::max(over_acd, over_adb));
    if (highest <= doubt) return highest < -doubt ? Reduction::inside : Reduction::unclear;
    const auto offer = [&](int ib, const Plain3& p, int ic, const Plain3& q, const Plain3& n)
        __attribute__((always_inline)) {
      SimplexSide other;
      on_triangle(a, 3, p, ib, q, ic, n, other);
      if (other.at.vv < s.at.vv) s = other;
    };
    if (over_abc > 0) offer(2, b, 1, c, abc);
    if (over_acd > 0) offer(1, c, 0, d, acd);
    if (over_adb > 0) offer(0, d, 2, b, adb);
  }
  keep_side(simplex, s);
  v = s.at;
  return Reduction::outside;
}

Reduction reduce_from_all_sides(Simplex& simplex, NearestPoint& v) {
  SimplexSide s;
  if (simplex.count == 3) {
    on_whole_triangle(simplex, 0, 1, 2, s);
  } else if (simplex.count == 4) {
    const double doubt = doubtful_volume(simplex);
    bool inside = true, unclear = false;
    static constexpr int side[4][4] = {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}};
    for (const auto& f : side) {
      const Plain3 &a = simplex.points[size_t(f[0])].w, &b = simplex.points[size_t(f[1])].w,
                   &c = simplex.points[size_t(f[2])].w, &d = simplex.points[size_t(f[3])].w;
      const Plain3 n = (b - a).cross(c - a);
      const double volume = n.dot(d - a);
      if (!(std::abs(volume) > doubt)) return Reduction::unclear;
      const double over = (volume > 0 ? 1 : -1) * n.dot(a);  // the origin's height, outward
      inside = inside && over < -doubt;
      unclear = unclear || std::abs(over) <= doubt;
      if (over <= 0) continue;
      SimplexSide other;
      on_whole_triangle(simplex, f[0], f[1], f[2], other);
      if (other.at.vv < s.at.vv) s = other;
    }
    if (inside) return Reduction::inside;
    if (unclear || s.count == 0) return Reduction::unclear;
  } else {
    return reduce(simplex, v);
  }
  keep_side(simplex, s);
  v = s.at;
  return Reduction::outside;
}

void set_weights(Simplex& s, const Plain3& v, double tolerance) {
  weigh_in_double(s);
  NearestPoint same;
  if ((s.nearest() - v).squared() > tolerance * tolerance) reduce_precisely(s, same);
}

}  // namespace tumble
