#include "engine/collision/gjk/simplex_side.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

void keep_side(Simplex& simplex, SimplexSide& s) {
  s.sort();
  simplex.keep(s.corner, s.count);
}

/// Nearest point on a triangle; all three sides are tested.
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
    const Reduction r = on_tetrahedron(point(3), point(2), point(1), point(0), s);
    if (r != Reduction::outside) return r;
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
    double size2 = 0;
    for (const DifferencePoint& p : simplex.points) size2 = std::max(size2, p.w.squared());
    const double doubt = doubtful_volume(size2);
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
  NearestPoint same;
  if (!weigh_in_double(s, v, tolerance)) reduce_precisely(s, same);
}

}  // namespace tumble
