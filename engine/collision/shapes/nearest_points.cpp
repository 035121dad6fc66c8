#include "engine/collision/shapes/nearest_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace tumble {
namespace {

/// The point of the surface at distance `radius` from a core point `from`, in the direction of p.
SurfacePoint about(const Vec3& from, double radius, const Vec3& p) {
  const Vec3 out = p - from;
  const double length = out.norm();
  SurfacePoint r;
  if (length > 0) r.normal = out / length;
  r.distance = length - radius;
  r.x = from + radius * r.normal;
  return r;
}

/// One axis of an ellipsoid, in the half in which the coordinate is not negative.
struct HalfAxis {
  double a, p;  ///< semi-axis, coordinate of the point [m]
  int index;
};

/// t + a^2 for the shortest axis `c` at the root where the sum over `axes` is 1; not negative.
/// `start` must not be beyond the root.
template <size_t N>
double ellipsoid_root(const std::array<HalfAxis, N>& axes, double c, double start) {
  constexpr int most = 100;
  double s = start;
  for (int k = 0; k < most; ++k) {
    double sum = -1, slope = 0;
    for (const HalfAxis& e : axes) {
      if (!(e.p > 0)) continue;
      const double below = s + (e.a - c) * (e.a + c), q = e.a * e.p / below;
      sum += q * q;
      slope += 2 * q * q / below;
    }
    const double next = s + sum / slope;
    if (!(next > s)) break;
    s = next;
  }
  return s;
}

/// The nearest point, in the octant of the point; axes in descending order.
Vec3 nearest_in_octant(const std::array<HalfAxis, 3>& e) {
  const double c = e[2].a;
  const auto along = [&](const HalfAxis& h, double s) {
    return h.p > 0 ? h.a * (h.a * h.p / (s + (h.a - c) * (h.a + c))) : 0;
  };
  // Each term alone gives a lower bound of the root.
  double start = 0;
  for (const HalfAxis& h : e)
    if (h.p > 0) start = std::max(start, h.a * h.p - (h.a - c) * (h.a + c));
  if (start > 0) {
    const double s = ellipsoid_root(e, c, start);
    return {along(e[0], s), along(e[1], s), along(e[2], s)};
  }
  // A point in the plane perpendicular to the shortest axis, and not far out: there t = -c^2, or
  // the root of the other terms.
  const std::array<HalfAxis, 2> rest{e[0], e[1]};
  double left = 1;
  for (const HalfAxis& h : rest) {
    const double x = along(h, 0) / h.a;
    left -= x * x;
  }
  if (left >= 0) return {along(e[0], 0), along(e[1], 0), c * std::sqrt(left)};
  const double s = ellipsoid_root(rest, c, 0);
  return {along(e[0], s), along(e[1], s), 0};
}

}  // namespace

SurfacePoint nearest_on_ball(double radius, const Vec3& p) {
  return about(Vec3::Zero(), radius, p);
}

SurfacePoint nearest_on_capsule(double half_height, double radius, const Vec3& p) {
  const Vec3 from(0, std::clamp(p.y(), -half_height, half_height), 0);
  if (p != from) return about(from, radius, p);
  return {from + Vec3(radius, 0, 0), Vec3::UnitX(), -radius};
}

SurfacePoint nearest_on_box(const Vec3& half, const Vec3& p) {
  const Vec3 over = p.cwiseAbs() - half, nearest = p.cwiseMax(-half).cwiseMin(half);
  const double outside = over.cwiseMax(0.0).norm();
  if (outside > 0) return {nearest, (p - nearest) / outside, outside};
  int axis = 0;
  SurfacePoint r;
  r.distance = over.maxCoeff(&axis);
  const double side = p[axis] < 0 ? -1 : 1;
  r.normal = side * Vec3::Unit(axis);
  r.x = nearest;
  r.x[axis] = side * half[axis];
  return r;
}

SurfacePoint nearest_on_cylinder(double half_height, double radius, const Vec3& p) {
  const double across = std::sqrt(p.x() * p.x() + p.z() * p.z());
  const Vec3 out = across > 0 ? Vec3(p.x() / across, 0, p.z() / across) : Vec3(Vec3::UnitX());
  const double up = p.y() < 0 ? -1 : 1;
  const double side = across - radius, end = std::fabs(p.y()) - half_height;
  const double beyond_side = std::max(side, 0.0), beyond_end = std::max(end, 0.0);
  const double outside = std::sqrt(beyond_side * beyond_side + beyond_end * beyond_end);
  const Vec3 in_disc = std::min(across, radius) * out;
  if (outside > 0) {
    const double y = std::clamp(p.y(), -half_height, half_height);
    return {in_disc + y * Vec3::UnitY(),
            (beyond_side * out + beyond_end * up * Vec3::UnitY()) / outside, outside};
  }
  if (side > end) return {radius * out + p.y() * Vec3::UnitY(), out, side};
  return {in_disc + up * half_height * Vec3::UnitY(), up * Vec3::UnitY(), end};
}

SurfacePoint nearest_on_ellipsoid(const Vec3& semi_axes, const Vec3& p) {
  // In units of the longest axis, with coordinates whose squares would underflow set to zero.
  const double unit = semi_axes.maxCoeff();
  constexpr double vanishing = 1e-140;
  std::array<HalfAxis, 3> e;
  for (int k = 0; k < 3; ++k) {
    const double q = std::fabs(p[k]) / unit;
    e[size_t(k)] = {semi_axes[k] / unit, q < vanishing ? 0 : q, k};
  }
  for (const auto& [i, j] : {std::pair<size_t, size_t>{0, 1}, {1, 2}, {0, 1}})
    if (e[i].a < e[j].a) std::swap(e[i], e[j]);
  const Vec3 nearest = nearest_in_octant(e);
  SurfacePoint r;
  Vec3 gradient;
  for (int k = 0; k < 3; ++k) {
    const HalfAxis& h = e[size_t(k)];
    const double sign = p[h.index] < 0 ? -1 : 1;
    r.x[h.index] = sign * unit * nearest[k];
    gradient[h.index] = sign * nearest[k] / (h.a * h.a);
  }
  r.normal = gradient.normalized();
  r.distance = r.normal.dot(p - r.x);
  return r;
}

}  // namespace tumble
