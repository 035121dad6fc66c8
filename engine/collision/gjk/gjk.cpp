#include "engine/collision/gjk/gjk.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Distances below this share of the largest coordinate cannot be told from contact.
constexpr double touching = 1e-14;

bool contains(const Simplex& s, const Vec3& w) {
  for (int i = 0; i < s.count; ++i)
    if (s.points[size_t(i)].w == w) return true;
  return false;
}

double largest(const Simplex& s) {
  double m = 0;
  for (int i = 0; i < s.count; ++i) m = std::max(m, s.points[size_t(i)].w.squaredNorm());
  return std::sqrt(m);
}

void write_answer(GjkResult& r, const Vec3& v) {
  r.distance = v.norm();
  r.a = r.simplex.nearest_a();
  r.b = r.simplex.nearest_b();
  if (r.status == GjkStatus::intersecting) {
    r.distance = r.lower_bound = 0;
  } else {
    r.normal = -v / r.distance;
    r.lower_bound = std::min(r.lower_bound, r.distance);
  }
}

}  // namespace

GjkResult gjk(const PlacedCore& A, const PlacedCore& B, const GjkOptions& options) {
  GjkResult r;
  Vec3 d = options.initial_direction;
  if (d.isZero()) d = B.centre() - A.centre();
  if (d.isZero()) d = Vec3::UnitX();
  r.simplex.points[0] = support(A, B, d);
  r.simplex.count = 1;
  Vec3 v = r.simplex.points[0].w;
  double vv = v.squaredNorm();
  for (r.iterations = 1; r.iterations <= options.max_iterations; ++r.iterations) {
    const double tiny = touching * largest(r.simplex);
    if (vv <= tiny * tiny) {
      r.status = GjkStatus::intersecting;
      write_answer(r, v);
      return r;
    }
    const DifferencePoint p = support(A, B, -v);
    const double vw = v.dot(p.w), length = std::sqrt(vv);
    r.lower_bound = std::max(r.lower_bound, vw / length);
    if (r.lower_bound > options.max_distance) {
      r.status = GjkStatus::beyond;
      write_answer(r, v);
      r.distance = r.lower_bound;
      return r;
    }
    // Converged, or nothing new: the support plane already passes through the simplex.
    if (vv - vw <= options.relative_tolerance * vv || contains(r.simplex, p.w)) break;

    Simplex next = r.simplex;
    next.points[size_t(next.count++)] = p;
    if (reduce(next)) {
      r.simplex = next;
      r.status = GjkStatus::intersecting;
      write_answer(r, v);
      return r;
    }
    const Vec3 nv = next.nearest();
    const double nvv = nv.squaredNorm();
    if (!(nvv < vv)) break;  // rounding: as close as it gets
    r.simplex = next;
    v = nv;
    vv = nvv;
  }
  r.status =
      r.iterations > options.max_iterations ? GjkStatus::max_iterations : GjkStatus::separated;
  write_answer(r, v);
  return r;
}

}  // namespace tumble
