#include "engine/geometry/wrap/surface_clash.hpp"

#include "engine/geometry/primitive_tests/triangle_pairs.hpp"
#include "engine/geometry/solid/star_arcs.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// Two triangles lie on either side of a plane across `m` through `p`, except for what is at p,
/// beyond rounding. Flat parts of a surface, where exact predicates are slow, are told apart by
/// this.
bool parted(const TriangleCorners& a, const TriangleCorners& b, const Vec3& p, const Vec3& m) {
  const double least = 1e-9 * m.norm();
  for (const Vec3& x : a)
    if (const Vec3 way = x - p; !way.isZero(0) && !(m.dot(way) > least * way.norm())) return false;
  for (const Vec3& x : b)
    if (const Vec3 way = x - p; !way.isZero(0) && !(m.dot(way) < -least * way.norm())) return false;
  return true;
}

Vec3 middle_of(const TriangleCorners& t) {
  return (t[0] + t[1] + t[2]) / 3;
}

/// The side shared by two triangles is bent by less than a right angle.
bool bent_little(const TriangleCorners& a, const TriangleCorners& b) {
  const Vec3 na = (a[1] - a[0]).cross(a[2] - a[0]), nb = (b[1] - b[0]).cross(b[2] - b[0]);
  return na.dot(nb) > 0.01 * na.norm() * nb.norm();
}

}  // namespace

bool clash(const NumberedTriangle& a, const NumberedTriangle& b) {
  size_t shared = 0, of_a = 0, of_b = 0;  // the last common corner, by place
  size_t apex_a = 0, apex_b = 0;          // the last that is not
  for (size_t i = 0; i < 3; ++i) {
    bool common = false;
    for (size_t j = 0; j < 3; ++j)
      if (a.id[i] == b.id[j]) ++shared, common = true, of_a = i, of_b = j;
    if (!common) apex_a = i;
  }
  for (size_t j = 0; j < 3; ++j)
    if (std::find(a.id.begin(), a.id.end(), b.id[j]) == a.id.end()) apex_b = j;
  if (shared == 0) {
    const Vec3 from = middle_of(b.at), m = middle_of(a.at) - from;
    double nearest = m.squaredNorm(), farthest = 0;
    for (const Vec3& x : a.at) nearest = std::min(nearest, m.dot(x - from));
    for (const Vec3& x : b.at) farthest = std::max(farthest, m.dot(x - from));
    return !(nearest > farthest + 1e-9 * m.squaredNorm()) && triangles_intersect(a.at, b.at);
  }
  // Beyond a common corner: the ray from it through a common point leaves one of the two within the
  // other.
  if (shared == 1) {
    const Vec3& p = a.at[of_a];
    const Vec3 m = (middle_of(a.at) - p).normalized() - (middle_of(b.at) - p).normalized();
    if (parted(a.at, b.at, p, m)) return false;
    return segment_triangle_intersect(a.at[(of_a + 1) % 3], a.at[(of_a + 2) % 3], b.at) ||
           segment_triangle_intersect(b.at[(of_b + 1) % 3], b.at[(of_b + 2) % 3], a.at);
  }
  if (shared == 2)
    return !bent_little(a.at, b.at) &&
           folded_at(a.at[(apex_a + 1) % 3], a.at[(apex_a + 2) % 3], a.at[apex_a], b.at[apex_b]);
  return true;
}

}  // namespace tumble
