#include "engine/collision/manifold_builder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

/// A later point must be better by this share to take the place of an earlier one.
constexpr double clearly = 1.02;

/// Gap at which a point counts half, in sizes of the whole.
constexpr double near_share = 0.01;

/// How much a point counts for what it spans; `k` [1/m] is 0 where all count alike.
double weight(const ManifoldPoint& p, double k) {
  return 1 / (1 + k * std::max(p.gap, 0.0));
}

/// Among the points no less deep than `gap`.
size_t farthest_from(std::span<const ManifoldPoint> points, size_t from, double gap, double k) {
  size_t best = from;
  double far2 = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const double w = weight(points[i], k);
    const double d2 = w * w * (points[i].x_world - points[from].x_world).squaredNorm();
    if (points[i].gap <= gap && d2 > clearly * far2) far2 = d2, best = i;
  }
  return best;
}

}  // namespace

void reduce_points(std::span<const ManifoldPoint> points, const Vec3& normal, Manifold& out,
                   PointChoice choice) {
  out.normal = normal;
  out.count = 0;
  if (points.size() <= 2) {
    for (const ManifoldPoint& p : points) out.points[size_t(out.count++)] = p;
    return;
  }
  size_t deepest = 0;
  double reach = 0;
  for (const ManifoldPoint& p : points)
    reach = std::max(reach, (p.x_world - points[0].x_world).squaredNorm());
  const double k =
      choice == PointChoice::nearest && reach > 0 ? 1 / (near_share * std::sqrt(reach)) : 0;
  const double level = 1e-4 * std::sqrt(reach);  // gaps closer than this count as equal
  for (size_t i = 1; i < points.size(); ++i)
    if (points[i].gap < points[deepest].gap - level) deepest = i;

  const size_t farthest =
      farthest_from(points, deepest, std::numeric_limits<double>::infinity(), k);
  // Back again, so that equally deep points in the middle of a line or face give way to its ends.
  deepest = farthest_from(points, farthest, points[deepest].gap + level, k);
  const Vec3 p0 = points[deepest].x_world;
  const double far2 = (points[farthest].x_world - p0).squaredNorm();
  out.points[size_t(out.count++)] = points[deepest];
  if (farthest == deepest) return;
  out.points[size_t(out.count++)] = points[farthest];

  const Vec3 across = normal.cross(points[farthest].x_world - p0);
  size_t left = deepest, right = deepest;
  double most_left = 1e-4 * far2, most_right = most_left;
  for (size_t i = 0; i < points.size(); ++i) {
    const double area = weight(points[i], k) * across.dot(points[i].x_world - p0);
    if (area > clearly * most_left) most_left = area, left = i;
    if (-area > clearly * most_right) most_right = -area, right = i;
  }
  if (left != deepest) out.points[size_t(out.count++)] = points[left];
  if (right != deepest) out.points[size_t(out.count++)] = points[right];
}

void ManifoldBuilder::finish(const Vec3& normal, uint64_t part, Manifold& out) const {
  reduce_points({points_.data(), size_t(count_)}, normal, out);
  out.part = part;
}

}  // namespace tumble
