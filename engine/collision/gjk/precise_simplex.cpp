// The nearest point of a simplex in double-double arithmetic.
#include "engine/collision/gjk/precise3.hpp"
#include "engine/collision/gjk/simplex.hpp"

namespace tumble {
namespace {

/// Triangles whose corners are nearer to a line than this have no normal that is accurate to double
/// precision; triangles of doubles that are not degenerate are far above it.
constexpr double least_sine2 = 1e-38;

/// A face of the simplex that contains the origin's projection.
struct PreciseFace {
  std::array<int, 4> corner;
  std::array<double, 4> weight;
  int count = 0;
  Precise3 v;
  DoubleDouble vv;
};

bool positive(const DoubleDouble& d) {
  return d.high > 0;
}

/// Projects the origin on the affine hull of the corners; false if the projection is outside the
/// face, or the corners are degenerate.
bool project(const std::array<Precise3, 4>& p, PreciseFace& f) {
  const auto at = [&](int i) -> const Precise3& { return p[size_t(f.corner[size_t(i)])]; };
  if (f.count == 1) {
    f.v = at(0);
    f.weight[0] = 1;
  } else if (f.count == 2) {
    const Precise3 u = at(1) - at(0);
    const DoubleDouble uu = u.dot(u), to_0 = at(1).dot(u), to_1 = -at(0).dot(u);
    if (!positive(uu) || !positive(to_0) || !positive(to_1)) return false;
    const DoubleDouble t = to_1 / uu;
    f.v = at(0) + u * t;
    f.weight = {(to_0 / uu).high, t.high, 0, 0};
  } else if (f.count == 3) {
    const Precise3 u = at(1) - at(0), w = at(2) - at(0), n = u.cross(w);
    const DoubleDouble nn = n.dot(n);
    if (!(nn.high > least_sine2 * u.dot(u).high * w.dot(w).high)) return false;
    const std::array<DoubleDouble, 3> area{n.dot(at(1).cross(at(2))), n.dot(at(2).cross(at(0))),
                                           n.dot(at(0).cross(at(1)))};
    for (size_t i = 0; i < 3; ++i) {
      if (!positive(area[i])) return false;
      f.weight[i] = (area[i] / nn).high;
    }
    f.v = n * (n.dot(at(0)) / nn);
  } else {
    const Precise3 u = at(1) - at(0), w = at(2) - at(0), t = at(3) - at(0);
    const DoubleDouble volume = u.dot(w.cross(t));
    const double size = u.dot(u).high * w.dot(w).high * t.dot(t).high;
    if (!(volume.high * volume.high > precise_noise * precise_noise * size)) return false;
    const std::array<DoubleDouble, 4> part{
        at(1).dot(at(2).cross(at(3))), -at(0).dot(at(2).cross(at(3))),
        at(0).dot(at(1).cross(at(3))), -at(0).dot(at(1).cross(at(2)))};
    for (size_t i = 0; i < 4; ++i) {
      if (part[i].high == 0 || (part[i].high > 0) != (volume.high > 0)) return false;
      f.weight[i] = (part[i] / volume).high;
    }
    f.v = precise({0, 0, 0});
  }
  f.vv = f.v.dot(f.v);
  return true;
}

}  // namespace

Reduction reduce_precisely(Simplex& simplex, NearestPoint& v) {
  std::array<Precise3, 4> p;
  for (int i = 0; i < simplex.count; ++i) p[size_t(i)] = precise(simplex.points[size_t(i)].w);
  // The nearest point is the nearest of the projections that are inside their faces.
  PreciseFace best;
  for (unsigned set = 1; set < 1u << simplex.count; ++set) {
    PreciseFace f;
    for (int i = 0; i < simplex.count; ++i)
      if (set >> i & 1) f.corner[size_t(f.count++)] = i;
    if (!project(p, f)) continue;
    if (best.count == 0 || positive(best.vv - f.vv)) best = f;
  }
  simplex.keep(best.corner.data(), best.count);
  simplex.weights = {0, 0, 0, 0};
  for (size_t i = 0; i < size_t(best.count); ++i) simplex.weights[i] = best.weight[i];
  v.v = v.along = {best.v.x.high, best.v.y.high, best.v.z.high};
  v.vv = best.vv.high;
  v.vv_rest = best.vv.low;
  return best.count == 4 ? Reduction::inside : Reduction::outside;
}

}  // namespace tumble
