#include "engine/geometry/constructions/closest_points.hpp"
#include "engine/geometry/primitive_tests/primitive_tests.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

double reach(const OrientedBox& box, const Vec3& axis) {
  return std::fabs(axis.dot(box.half_axes.col(0))) + std::fabs(axis.dot(box.half_axes.col(1))) +
         std::fabs(axis.dot(box.half_axes.col(2)));
}

/// Directions of a box's faces: an axis of no length is replaced by the cross product of the
/// others, so that flat boxes and boxes that are segments have all the axes they need.
Mat3 directions(const OrientedBox& box) {
  Mat3 d = box.half_axes;
  for (int k = 0; k < 3; ++k) {
    if (d.col(k).isZero(0)) d.col(k) = d.col((k + 1) % 3).cross(d.col((k + 2) % 3));
  }
  return d;
}

}  // namespace

bool boxes_intersect(const OrientedBox& a, const OrientedBox& b) {
  const Vec3 between = b.centre - a.centre;
  const auto separates = [&](const Vec3& axis) {
    return std::fabs(axis.dot(between)) > reach(a, axis) + reach(b, axis);
  };
  const Mat3 da = directions(a), db = directions(b);
  for (int k = 0; k < 3; ++k) {
    if (separates(da.col(k)) || separates(db.col(k))) return false;
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const Vec3 axis = da.col(i).cross(db.col(j));
      // Edges that are parallel up to rounding span no axis of their own.
      if (axis.squaredNorm() <= 1e-28 * da.col(i).squaredNorm() * db.col(j).squaredNorm()) continue;
      if (separates(axis)) return false;
    }
  }
  // Boxes that are points or segments may lack axes; the line between the centres helps them.
  return !separates(between);
}

bool box_triangle_intersect(const Aabb& box, const std::array<Vec3, 3>& t) {
  const Vec3 centre = box.centre(), half = 0.5 * box.extent();
  const std::array<Vec3, 3> p{t[0] - centre, t[1] - centre, t[2] - centre};
  Aabb around;
  for (const Vec3& c : t) around.include(c);
  if (!around.overlaps(box)) return false;
  const auto separates = [&](const Vec3& axis) {
    const double a = axis.dot(p[0]), b = axis.dot(p[1]), c = axis.dot(p[2]);
    const double r = half.dot(axis.cwiseAbs());
    return std::min({a, b, c}) > r || std::max({a, b, c}) < -r;
  };
  const std::array<Vec3, 3> sides{p[1] - p[0], p[2] - p[1], p[0] - p[2]};
  if (separates(sides[0].cross(sides[1]))) return false;
  for (const Vec3& side : sides) {
    for (int k = 0; k < 3; ++k) {
      if (separates(side.cross(Vec3::Unit(k)))) return false;
    }
  }
  return true;
}

bool sphere_box_intersect(const Vec3& centre, double radius, const Aabb& box) {
  const Vec3 nearest = centre.cwiseMax(box.min).cwiseMin(box.max);
  return (centre - nearest).squaredNorm() <= radius * radius;
}

bool sphere_triangle_intersect(const Vec3& centre, double radius, const std::array<Vec3, 3>& t) {
  return closest_on_triangle(centre, t[0], t[1], t[2]).squared_distance <= radius * radius;
}

bool segment_box_intersect(const Vec3& p, const Vec3& q, const Aabb& box) {
  // Separating axes of a segment and a box: the three normals and three cross products.
  const Vec3 centre = box.centre(), half = 0.5 * box.extent();
  const Vec3 middle = 0.5 * (p + q) - centre, arm = 0.5 * (q - p);
  Aabb around;
  around.include(p);
  around.include(q);
  if (!around.overlaps(box)) return false;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const double cross = std::fabs(middle[i] * arm[j] - middle[j] * arm[i]);
    if (cross > half[i] * std::fabs(arm[j]) + half[j] * std::fabs(arm[i])) return false;
  }
  return true;
}

}  // namespace tumble
