#include "engine/scene/workloads/tori_overlaps.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr int around = 24, across = 12;

std::vector<Vec3> points_of_torus(const ToriOnTerrain& tori) {
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

/// Signed distance from the surface, in the torus's own frame.
double torus_distance(const ToriOnTerrain& tori, const Vec3& x) {
  const double from_ring = std::hypot(x.x(), x.z()) - tori.major;
  return std::hypot(from_ring, x.y()) - tori.minor;
}

double depth_in_ground(const ToriOnTerrain& tori, const std::vector<Vec3>& points) {
  double depth = 0;
  for (const Vec3& p : points)
    if (std::abs(p.x()) < tori.half_width && std::abs(p.z()) < tori.half_width)
      depth = std::max(depth, tori.height(p.x(), p.z()) - p.y());
  return std::min(depth, 2.0);
}

double depth_in_torus(const ToriOnTerrain& tori, const std::vector<Vec3>& points,
                      const Pose& other) {
  double depth = 0;
  for (const Vec3& p : points)
    depth = std::max(depth, -torus_distance(tori, other.inverse_point(p)));
  return depth;
}

}  // namespace

OverlapDepths tori_overlaps(const ToriOnTerrain& tori, std::span<const RigidBody> bodies) {
  OverlapDepths out;
  const std::vector<Vec3> own = points_of_torus(tori);
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
