#include "engine/geometry/hierarchy/hull_separation.hpp"

#include "engine/geometry/constructions/closest_points.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

const Vec3& furthest(std::span<const Vec3> points, const Vec3& direction) {
  size_t best = 0;
  double most = points[0].dot(direction);
  for (size_t i = 1; i < points.size(); ++i) {
    const double x = points[i].dot(direction);
    if (x > most) {
      most = x;
      best = i;
    }
  }
  return points[best];
}

/// Up to four points of the Minkowski difference, reduced to those whose hull contains the point
/// nearest to the origin (GJK).
struct Simplex {
  std::array<Vec3, 4> p;
  size_t size = 0;

  bool holds(const Vec3& x) const {
    for (size_t i = 0; i < size; ++i) {
      if (p[i] == x) return true;
    }
    return false;
  }

  /// The point of the simplex nearest to the origin; drops points that do not support it. Zero if
  /// the origin is inside.
  Vec3 nearest() {
    switch (size) {
      case 1:
        return p[0];
      case 2:
        return on_segment();
      case 3:
        return on_triangle({0, 1, 2});
      default:
        return on_tetrahedron();
    }
  }

 private:
  Vec3 on_segment() {
    const SegmentPoint s = closest_on_segment(Vec3::Zero(), p[0], p[1]);
    if (s.s <= 0) size = 1;
    if (s.s >= 1) {
      p[0] = p[1];
      size = 1;
    }
    return s.point;
  }

  Vec3 keep(const TrianglePoint& t, const std::array<size_t, 3>& at) {
    const std::array<Vec3, 3> corners{p[at[0]], p[at[1]], p[at[2]]};
    size = 0;
    for (size_t k = 0; k < 3; ++k) {
      if (t.barycentric[int(k)] > 0) p[size++] = corners[k];
    }
    return t.point;
  }

  Vec3 on_triangle(const std::array<size_t, 3>& at) {
    return keep(closest_on_triangle(Vec3::Zero(), p[at[0]], p[at[1]], p[at[2]]), at);
  }

  Vec3 on_tetrahedron() {
    static constexpr std::array<std::array<size_t, 4>, 4> faces = {
        {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}}};
    TrianglePoint best;
    best.squared_distance = std::numeric_limits<double>::infinity();
    std::array<size_t, 3> best_face{};
    bool outside = false;
    for (const auto& f : faces) {
      const Vec3 n = (p[f[1]] - p[f[0]]).cross(p[f[2]] - p[f[0]]);
      const double of_origin = -n.dot(p[f[0]]), of_other = n.dot(p[f[3]] - p[f[0]]);
      // If the sign is in doubt (no volume), the face is examined.
      if (of_origin * of_other > 0) continue;
      outside = true;
      const TrianglePoint t = closest_on_triangle(Vec3::Zero(), p[f[0]], p[f[1]], p[f[2]]);
      if (!(t.squared_distance < best.squared_distance)) continue;
      best = t;
      best_face = {f[0], f[1], f[2]};
    }
    if (!outside) return Vec3::Zero();
    return keep(best, best_face);
  }
};

}  // namespace

DistanceBracket hull_distance(std::span<const Vec3> a, std::span<const Vec3> b, double enough) {
  constexpr int most_steps = 64;
  Simplex simplex;
  simplex.p[0] = a[0] - b[0];
  simplex.size = 1;
  DistanceBracket out{0, std::numeric_limits<double>::infinity()};
  for (int step = 0; step < most_steps; ++step) {
    const Vec3 v = simplex.nearest();
    const double square = v.squaredNorm();
    const double length = std::sqrt(square);
    // v is a difference of two points of the hulls, up to the rounding of coordinates.
    const Vec3 &on_a = furthest(a, -v), &on_b = furthest(b, v);
    const double rounding = 4e-16 * (on_a.cwiseAbs().sum() + on_b.cwiseAbs().sum() + length);
    out.upper = std::min(out.upper, length + rounding);
    // Below this, squares and products lose digits to underflow: counts as touching.
    if (!(square > 1e-290) || out.upper <= enough) return out;
    const Vec3 w = on_a - on_b;
    out.lower = std::max(out.lower, v.dot(w) / length - rounding);
    if (out.lower > enough) return out;
    if (square - v.dot(w) <= 1e-13 * square || simplex.holds(w)) return out;
    simplex.p[simplex.size++] = w;
  }
  return out;
}

bool hulls_apart(std::span<const Vec3> a, std::span<const Vec3> b, double reach) {
  return hull_distance(a, b, reach).lower > reach;
}

}  // namespace tumble
