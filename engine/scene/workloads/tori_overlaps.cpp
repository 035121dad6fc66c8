#include "engine/scene/workloads/tori_overlaps.hpp"

#include "engine/geometry/constructions/closest_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

constexpr int around = 24, across = 12;

std::vector<Vec3> points_of_smooth(const ToriOnTerrain& tori) {
  std::vector<Vec3> out;
  for (int i = 0; i < around; ++i) {
    const double u = 2 * M_PI * i / around;
    for (int j = 0; j < across; ++j) {
      const double v = 2 * M_PI * j / across, r = tori.major + tori.minor * std::cos(v);
      out.emplace_back(r * std::cos(u), tori.minor * std::sin(v), r * std::sin(u));
    }
  }
  return out;
}

std::vector<Vec3> points_of_facets(const TriangleMesh& mesh) {
  std::vector<Vec3> out = mesh.vertices;
  for (const auto& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    out.push_back((a + b + c) / 3);
    // Each edge of a closed surface has two triangles, one each way.
    for (int k = 0; k < 3; ++k)
      if (t[size_t(k)] < t[size_t((k + 1) % 3)])
        out.push_back(0.5 * (mesh.vertices[t[size_t(k)]] + mesh.vertices[t[size_t((k + 1) % 3)]]));
  }
  return out;
}

/// Signed distance from the surface, for a point in the torus's own frame.
double torus_distance(const ToriOnTerrain& tori, const Vec3& x) {
  const double from_ring = std::hypot(x.x(), x.z()) - tori.major;
  return std::hypot(from_ring, x.y()) - tori.minor;
}

/// Depth of a point inside the solid that a mesh bounds [m]; 0 outside. The total solid angle of
/// the triangles distinguishes inside from outside (A. van Oosterom, J. Strackee, "The solid angle
/// of a plane triangle", 1983).
double depth_in_facets(const TriangleMesh& mesh, const Vec3& x) {
  double angle = 0, nearest2 = std::numeric_limits<double>::infinity();
  for (const auto& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vec3 u = a - x, v = b - x, w = c - x;
    const double lu = u.norm(), lv = v.norm(), lw = w.norm();
    angle += 2 * std::atan2(u.dot(v.cross(w)),
                            lu * lv * lw + u.dot(v) * lw + u.dot(w) * lv + v.dot(w) * lu);
    nearest2 = std::min(nearest2, (closest_on_triangle(x, a, b, c).point - x).squaredNorm());
  }
  return std::abs(angle) > 2 * M_PI ? std::sqrt(nearest2) : 0;
}

/// Height of the smooth ground, or of its triangles: each cell is cut from its corner of greatest x
/// to that of greatest z.
double ground_height(const ToriOnTerrain& tori, double x, double z) {
  if (tori.cells == 0) return tori.height(x, z);
  const double size = 2 * tori.half_width / tori.cells;
  const double i = std::floor((x + tori.half_width) / size);
  const double j = std::floor((z + tori.half_width) / size);
  const auto corner = [&](double di, double dj) {
    return tori.height((i + di) * size - tori.half_width, (j + dj) * size - tori.half_width);
  };
  const double u = (x + tori.half_width) / size - i, v = (z + tori.half_width) / size - j;
  const double along_x = corner(1, 0), along_z = corner(0, 1);
  if (u + v <= 1) {
    const double h = corner(0, 0);
    return h + u * (along_x - h) + v * (along_z - h);
  }
  const double h = corner(1, 1);
  return h + (1 - u) * (along_z - h) + (1 - v) * (along_x - h);
}

double depth_in_ground(const ToriOnTerrain& tori, const std::vector<Vec3>& points) {
  double depth = 0;
  for (const Vec3& p : points)
    if (std::abs(p.x()) < tori.half_width && std::abs(p.z()) < tori.half_width)
      depth = std::max(depth, ground_height(tori, p.x(), p.z()) - p.y());
  return std::min(depth, 2.0);
}

double depth_in_torus(const ToriOnTerrain& tori, const std::vector<Vec3>& points,
                      const Pose& other) {
  constexpr double facets_beyond = 0.01;  // chords across the hole lie outside of the smooth torus
  double depth = 0;
  for (const Vec3& p : points) {
    const Vec3 x = other.inverse_point(p);
    const double smooth = -torus_distance(tori, x);
    if (!tori.facets) {
      depth = std::max(depth, smooth);
    } else if (smooth > -facets_beyond) {
      depth = std::max(depth, depth_in_facets(*tori.facets, x));
    }
  }
  return depth;
}

}  // namespace

OverlapDepths tori_overlaps(const ToriOnTerrain& tori, std::span<const RigidBody> bodies) {
  OverlapDepths out;
  const std::vector<Vec3> own =
      tori.facets ? points_of_facets(*tori.facets) : points_of_smooth(tori);
  const double reach = 2 * (tori.major + tori.minor);
  for (const RigidBody& a : bodies) {
    if (!a.dynamic() || has_escaped(a)) continue;
    std::vector<Vec3> points;
    for (const Vec3& p : own) points.push_back(a.pose.point(p));
    out.add(depth_in_ground(tori, points));
    for (const RigidBody& b : bodies)
      if (&b != &a && b.dynamic() && (a.pose.x - b.pose.x).norm() < reach)
        out.add(depth_in_torus(tori, points, b.pose));
  }
  return out;
}

}  // namespace tumble
