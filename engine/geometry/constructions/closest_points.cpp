#include "engine/geometry/constructions/closest_points.hpp"

#include "engine/geometry/constructions/narrow_triangle.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tumble {
namespace {

double clamp01(double x) {
  return std::min(std::max(x, 0.0), 1.0);
}

/// Barycentric weights of the projection of `p` on the plane of a triangle, times |n|^2, where n is
/// the cross product of two sides.
Vec3 edge_functions(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& n) {
  return {n.dot((c - b).cross(p - b)), n.dot((a - c).cross(p - c)), n.dot((b - a).cross(p - a))};
}

/// Whether the cross product of two sides has lost so many digits to cancellation that quantities
/// depending on its direction must be computed in double-double arithmetic.
bool is_narrow(const Vec3& n, const Vec3& a, const Vec3& b, const Vec3& c) {
  constexpr double sine = 1e-3;
  const double longest =
      std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return !(n.squaredNorm() > sine * sine * longest * longest);
}

/// The point where a segment crosses the interior of a triangle, if it does.
std::optional<ClosestPair> crossing(const Vec3& s0, const Vec3& s1, const std::array<Vec3, 3>& t) {
  const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
  if (is_narrow(n, t[0], t[1], t[2])) {
    const auto along = narrow_triangle_crossing(s0, s1, t);
    if (!along) return std::nullopt;
    const Vec3 p = s0 + *along * (s1 - s0);
    return ClosestPair{p, p, 0};
  }
  const double d0 = n.dot(s0 - t[0]), d1 = n.dot(s1 - t[0]);
  if ((d0 > 0 && d1 > 0) || (d0 < 0 && d1 < 0) || d0 == d1) return std::nullopt;
  const Vec3 p = s0 + (d0 / (d0 - d1)) * (s1 - s0);
  const Vec3 w = edge_functions(p, t[0], t[1], t[2], n);
  if (!(w.minCoeff() >= 0) || !(n.squaredNorm() > 0)) return std::nullopt;
  return ClosestPair{p, p, 0};
}

TriangleFeature side_feature(unsigned k, double s) {
  if (s <= 0) return TriangleFeature(k);
  if (s >= 1) return TriangleFeature((k + 1) % 3);
  return TriangleFeature(3 + k);
}

template <class Pair>
bool take_nearer(Pair& best, const Pair& candidate) {
  if (!(candidate.squared_distance < best.squared_distance)) return false;
  best = candidate;
  return true;
}

}  // namespace

SegmentPoint closest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double square = d.squaredNorm();
  const double along = d.dot(p - a);
  if (!(along > 0) || !(square > 0)) return {a, 0};
  if (along >= square) return {b, 1};
  const double s = along / square;
  return {a + s * d, s};
}

SegmentPair closest_segment_segment(const Vec3& a0, const Vec3& a1, const Vec3& b0,
                                    const Vec3& b1) {
  const Vec3 u = a1 - a0, v = b1 - b0, w = a0 - b0;
  const auto at = [&](double s, double t) {
    SegmentPair out;
    out.s = s;
    out.t = t;
    out.on_a = s >= 1 ? a1 : Vec3(a0 + s * u);
    out.on_b = t >= 1 ? b1 : Vec3(b0 + t * v);
    out.squared_distance = (out.on_a - out.on_b).squaredNorm();
    return out;
  };
  // Nearest points of the lines, from cross products: the normal equations would lose half the
  // digits at small angles.
  const Vec3 n = u.cross(v);
  const double square = n.squaredNorm(), lengths = u.squaredNorm() * v.squaredNorm();
  const auto inner = [&] {
    double s = clamp01(v.cross(w).dot(n) / square);
    const SegmentPoint on_b = closest_on_segment(a0 + s * u, b0, b1);
    s = closest_on_segment(on_b.point, a0, a1).s;
    return at(s, on_b.s);
  };
  if (square > 1e-8 * lengths) return inner();
  // Nearly parallel, or one has no length: some end is (nearly) a nearest point, unless the two
  // cross at a small angle, which the last candidate covers.
  SegmentPair best = at(0, closest_on_segment(a0, b0, b1).s);
  take_nearer(best, at(closest_on_segment(b0, a0, a1).s, 0));
  take_nearer(best, at(closest_on_segment(b1, a0, a1).s, 1));
  take_nearer(best, at(1, closest_on_segment(a1, b0, b1).s));
  if (square > 0) take_nearer(best, inner());
  return best;
}

SegmentPair closest_line_segment(const Vec3& origin, const Vec3& direction, const Vec3& b0,
                                 const Vec3& b1) {
  SegmentPair out;
  const Vec3 v = b1 - b0, w = b0 - origin;
  const double length = direction.squaredNorm();
  // Only the components of w and v perpendicular to the line matter; cross products keep all their
  // digits at small angles.
  const Vec3 n = direction.cross(v);
  if (!(length > 0)) {
    const SegmentPoint on_b = closest_on_segment(origin, b0, b1);
    out.t = on_b.s;
    out.on_b = on_b.point;
  } else {
    const double square = n.squaredNorm();
    out.t = square > 0 ? clamp01(-direction.cross(w).dot(n) / square) : 0;
    out.on_b = out.t >= 1 ? b1 : Vec3(b0 + out.t * v);
    out.s = (out.on_b - origin).dot(direction) / length;
  }
  out.on_a = origin + out.s * direction;
  out.squared_distance = (out.on_a - out.on_b).squaredNorm();
  return out;
}

TrianglePoint closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = (b - a).cross(c - a);
  const Vec3 w =
      is_narrow(n, a, b, c) ? narrow_triangle_weights(p, {a, b, c}) : edge_functions(p, a, b, c, n);
  TrianglePoint out;
  if (w.minCoeff() > 0) {
    out.barycentric = w / w.sum();
    // Relative to a corner, so that triangles far from the origin keep their accuracy.
    out.point = a + out.barycentric.y() * (b - a) + out.barycentric.z() * (c - a);
    out.feature = TriangleFeature::face;
    out.squared_distance = (p - out.point).squaredNorm();
    return out;
  }
  // The nearest point is on a side whose line separates p from the triangle. If the foot of the
  // perpendicular lies on such a side it is the answer, since the triangle is on the other side of
  // that line; comparing sides by distance would lose half the digits of the point.
  const Vec3* corners[3] = {&a, &b, &c};
  out.squared_distance = std::numeric_limits<double>::infinity();
  for (unsigned k = 0; k < 3; ++k) {
    if (w[(k + 2) % 3] > 0) continue;
    const unsigned next = (k + 1) % 3;
    const SegmentPoint near = closest_on_segment(p, *corners[k], *corners[next]);
    const double d = (p - near.point).squaredNorm();
    const bool foot = near.s > 0 && near.s < 1;
    if (!foot && !(d < out.squared_distance)) continue;
    out.point = near.point;
    out.squared_distance = d;
    out.barycentric = Vec3::Zero();
    out.barycentric[k] = 1 - near.s;
    out.barycentric[next] = near.s;
    out.feature = side_feature(k, near.s);
    if (foot) break;
  }
  return out;
}

ClosestPair closest_segment_triangle(const Vec3& s0, const Vec3& s1, const std::array<Vec3, 3>& t) {
  if (const auto hit = crossing(s0, s1, t)) return *hit;
  ClosestPair best;
  best.squared_distance = std::numeric_limits<double>::infinity();
  for (const Vec3& end : {s0, s1}) {
    const TrianglePoint near = closest_on_triangle(end, t[0], t[1], t[2]);
    take_nearer(best, ClosestPair{end, near.point, near.squared_distance});
  }
  for (unsigned k = 0; k < 3; ++k) {
    take_nearer<ClosestPair>(best, closest_segment_segment(s0, s1, t[k], t[(k + 1) % 3]));
  }
  return best;
}

TrianglePair closest_triangle_triangle(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  TrianglePair best;
  best.squared_distance = std::numeric_limits<double>::infinity();
  const auto offer = [&](const ClosestPair& pair, TriangleFeature fa, TriangleFeature fb) {
    if (!(pair.squared_distance < best.squared_distance)) return;
    static_cast<ClosestPair&>(best) = pair;
    best.feature_a = fa;
    best.feature_b = fb;
  };
  for (unsigned k = 0; k < 3; ++k) {
    const auto side = TriangleFeature(3 + k);
    if (const auto hit = crossing(a[k], a[(k + 1) % 3], b)) {
      offer(*hit, side, TriangleFeature::face);
      return best;
    }
    if (const auto hit = crossing(b[k], b[(k + 1) % 3], a)) {
      offer(*hit, TriangleFeature::face, side);
      return best;
    }
  }
  for (unsigned k = 0; k < 3; ++k) {
    const TrianglePoint on_b = closest_on_triangle(a[k], b[0], b[1], b[2]);
    offer({a[k], on_b.point, on_b.squared_distance}, TriangleFeature(k), on_b.feature);
    const TrianglePoint on_a = closest_on_triangle(b[k], a[0], a[1], a[2]);
    offer({on_a.point, b[k], on_a.squared_distance}, on_a.feature, TriangleFeature(k));
  }
  for (unsigned i = 0; i < 3; ++i) {
    for (unsigned j = 0; j < 3; ++j) {
      const SegmentPair s = closest_segment_segment(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]);
      offer(s, side_feature(i, s.s), side_feature(j, s.t));
    }
  }
  return best;
}

}  // namespace tumble
