#include "engine/geometry/hierarchy/triangle_decisions.hpp"

#include "engine/geometry/hierarchy/hull_separation.hpp"
#include "engine/geometry/primitive_tests/primitive_tests.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Certain position of three points relative to a plane: all above, all below, or on both sides;
/// `unsure` if a sign is not certain.
enum class Sides { below, both, above, unsure };

struct PlaneSides {
  Sides sides;
  std::array<double, 3> height;  ///< times twice the area
};

double largest(const Vec3& v) {
  return std::max({std::fabs(v.x()), std::fabs(v.y()), std::fabs(v.z())});
}

/// Heights of the corners of u above the plane of t. Rounding: with all differences of coordinates
/// at most m, each height is a sum of six products of three differences; every product passes at
/// most eight roundings, so the error is below 6 * 8 * 2^-53 m^3 < 6e-15 m^3 (the bound used is
/// larger; differences themselves are rounded once each, which the eight include).
PlaneSides plane_sides(const TriangleCorners& t, const Vec3& normal, double extent,
                       const TriangleCorners& u) {
  PlaneSides out;
  int above = 0, below = 0;
  for (size_t k = 0; k < 3; ++k) {
    const Vec3 d = u[k] - t[0];
    out.height[k] = normal.dot(d);
    const double bound = 1e-14 * extent * extent * largest(d) + 1e-290;
    above += out.height[k] > bound;
    below += out.height[k] < -bound;
  }
  out.sides = above == 3           ? Sides::above
              : below == 3         ? Sides::below
              : above + below == 3 ? Sides::both
                                   : Sides::unsure;
  return out;
}

/// Index of the corner that is alone on its side, 0 to 2.
size_t lone_corner(const std::array<double, 3>& h) {
  const bool a = h[0] > 0, b = h[1] > 0, c = h[2] > 0;
  return b == c ? 0 : a == c ? 1 : 2;
}

/// Sign of (b - a) x (c - a) . (d - a) if certain, otherwise 0.
int sure_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const double volume = u.cross(v).dot(w);
  const double bound = 1e-14 * largest(u) * largest(v) * largest(w) + 1e-290;
  return volume > bound ? 1 : volume < -bound ? -1 : 0;
}

/// For triangles that cross each other's planes, with certain signs: whether the intervals in which
/// they cut the common line of the planes overlap (Guigue & Devillers 2003). Returns 1 yes, -1 no,
/// 0 in doubt.
int intervals_overlap(const TriangleCorners& a, const std::array<double, 3>& side_a,
                      const TriangleCorners& b, const std::array<double, 3>& side_b) {
  const size_t i = lone_corner(side_a), j = lone_corner(side_b);
  const Vec3 &p = a[i], &u = b[j];
  Vec3 q = a[(i + 1) % 3], r = a[(i + 2) % 3], v = b[(j + 1) % 3], w = b[(j + 2) % 3];
  // Rotated so that each lone corner is above the other's plane.
  if (side_b[j] < 0) std::swap(q, r);
  if (side_a[i] < 0) std::swap(v, w);
  const int first = sure_orientation(p, q, u, v), second = sure_orientation(p, r, w, u);
  if (first > 0 || second > 0) return -1;
  return first < 0 && second < 0 ? 1 : 0;
}

double extent_of(const TriangleCorners& t) {
  return std::max(largest(t[1] - t[0]), largest(t[2] - t[0]));
}

bool boxes_within(const TriangleCorners& a, const TriangleCorners& b, double margin) {
  const auto low = [](const TriangleCorners& t) { return t[0].cwiseMin(t[1]).cwiseMin(t[2]); };
  const auto high = [](const TriangleCorners& t) { return t[0].cwiseMax(t[1]).cwiseMax(t[2]); };
  return ((low(b) - high(a)).array() <= margin).all() &&
         ((low(a) - high(b)).array() <= margin).all();
}

bool corners_within(const TriangleCorners& a, const TriangleCorners& b, double margin) {
  for (const Vec3& p : a)
    for (const Vec3& q : b)
      if ((p - q).squaredNorm() <= margin * margin) return true;
  return false;
}

/// Whether all corners of b are certainly farther than `margin` on one side of a's plane. The bound
/// accounts for heights as products of three lengths with about a dozen roundings; the normal of a
/// needle may consist of rounding errors only.
bool beyond_plane(const TriangleCorners& a, const TriangleCorners& b, double margin) {
  const Vec3 n = (a[1] - a[0]).cross(a[2] - a[0]);
  const std::array<Vec3, 3> way{b[0] - a[0], b[1] - a[0], b[2] - a[0]};
  const double h0 = n.dot(way[0]), h1 = n.dot(way[1]), h2 = n.dot(way[2]);
  const double extent = extent_of(a);
  const double reach = std::max({largest(way[0]), largest(way[1]), largest(way[2])});
  const double far = margin * n.norm() * (1 + 1e-12) + 0x1p-46 * extent * extent * reach;
  return std::min({h0, h1, h2}) > far || std::max({h0, h1, h2}) < -far;
}

}  // namespace

bool triangles_meet(const TriangleCorners& a, const TriangleCorners& b) {
  if (!boxes_within(a, b, 0)) return false;
  const Vec3 normal_a = (a[1] - a[0]).cross(a[2] - a[0]);
  const PlaneSides of_b = plane_sides(a, normal_a, extent_of(a), b);
  if (of_b.sides == Sides::above || of_b.sides == Sides::below) return false;
  const Vec3 normal_b = (b[1] - b[0]).cross(b[2] - b[0]);
  const PlaneSides of_a = plane_sides(b, normal_b, extent_of(b), a);
  if (of_a.sides == Sides::above || of_a.sides == Sides::below) return false;
  if (of_a.sides == Sides::both && of_b.sides == Sides::both) {
    const int answer = intervals_overlap(a, of_a.height, b, of_b.height);
    if (answer != 0) return answer > 0;
  }
  return triangles_intersect(a, b);
}

bool triangles_near(const TriangleCorners& a, const TriangleCorners& b, double margin) {
  if (!(margin > 0)) return triangles_meet(a, b);
  if (!boxes_within(a, b, margin)) return false;
  if (corners_within(a, b, margin)) return true;
  if (beyond_plane(a, b, margin) || beyond_plane(b, a, margin)) return false;
  return closest_triangle_triangle(a, b).squared_distance <= margin * margin ||
         triangles_meet(a, b);
}

bool triangle_meets_box(const TriangleMesh& mesh, uint32_t t, const Aabb& box) {
  return triangle_bounds(mesh, t).overlaps(box) && box_triangle_intersect(box, corners(mesh, t));
}

bool neighbours(const TriangleMesh& mesh, uint32_t a, uint32_t b) {
  for (uint32_t v : mesh.triangles[a]) {
    for (uint32_t w : mesh.triangles[b]) {
      if (v == w) return true;
    }
  }
  return false;
}

double turned_reach(const TriangleCorners& t, const MotionBound& motion) {
  double square = 0;
  for (const Vec3& p : t) square = std::max(square, (p - motion.centre).squaredNorm());
  return motion.chord() * std::sqrt(square);
}

bool swept_triangles_near(const TriangleCorners& a, const TriangleCorners& b,
                          const Vec3& translation, double reach) {
  std::array<Vec3, 6> prism;
  for (size_t k = 0; k < 3; ++k) {
    prism[k] = b[k];
    prism[k + 3] = b[k] + translation;
  }
  return !hulls_apart(a, prism, reach);
}

bool triangle_boxes_near(const TriangleMesh& mesh_a, uint32_t a, const TriangleMesh& mesh_b,
                         uint32_t b, const Pose& pose, double margin) {
  Aabb b_in_a, a_in_b;
  for (size_t k = 0; k < 3; ++k) {
    b_in_a.include(pose.point(mesh_b.corner(b, k)));
    a_in_b.include(pose.inverse_point(mesh_a.corner(a, k)));
  }
  return triangle_bounds(mesh_a, a).inflated(margin).overlaps(b_in_a) &&
         triangle_bounds(mesh_b, b).inflated(margin).overlaps(a_in_b);
}

}  // namespace tumble
