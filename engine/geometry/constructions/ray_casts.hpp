#pragma once
#include "engine/geometry/constructions/projections.hpp"
#include "engine/geometry/constructions/ray.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>

namespace tumble {

/// Half-space normal.dot(x) <= offset.
std::optional<RayHit> ray_half_space(const Ray& ray, const Plane& plane, double t_max);
std::optional<RayHit> ray_sphere(const Ray& ray, const Vec3& centre, double radius, double t_max);
/// Box about the origin with half extents `half`.
std::optional<RayHit> ray_box(const Ray& ray, const Vec3& half, double t_max);
/// Capsule about the origin along Y: segment of half length `half_height`, radius `radius`.
std::optional<RayHit> ray_capsule(const Ray& ray, double half_height, double radius, double t_max);
/// Solid cylinder about the origin along Y.
std::optional<RayHit> ray_cylinder(const Ray& ray, double half_height, double radius, double t_max);
/// Convex solid, the intersection of half-spaces.
std::optional<RayHit> ray_convex(const Ray& ray, const Plane* planes, size_t count, double t_max);

/// Hit of a ray with a triangle, seen from either side.
struct RayTriangleHit {
  double t = 0;
  Vec3 barycentric = Vec3::Zero();  ///< weights of the corners
  bool front = true;                ///< the ray meets the outer (counter-clockwise) side
};

/// The shear of Woop, Benthin & Wald, "Watertight Ray/Triangle Intersection" (2013), made once per
/// ray: no ray passes between two triangles that share an edge.
class RayShear {
 public:
  explicit RayShear(const Ray& ray);
  /// Nothing outside [0, t_max], for triangles without area and for those edge-on.
  std::optional<RayTriangleHit> triangle(const Vec3& a, const Vec3& b, const Vec3& c,
                                         double t_max) const;
  bool valid() const { return valid_; }

 private:
  Vec3 origin_;
  int x_ = 0, y_ = 1, z_ = 2;
  double shear_x_ = 0, shear_y_ = 0, shear_z_ = 0;
  bool valid_ = false;
};

inline std::optional<RayTriangleHit> RayShear::triangle(const Vec3& a, const Vec3& b, const Vec3& c,
                                                        double t_max) const {
  if (!valid_) return std::nullopt;
  // Relative to the origin, along z and sheared onto it.
  struct Corner {
    double x, y, z;
  };
  const auto seen = [this](const Vec3& p) {
    const double z = p[z_] - origin_[z_];
    return Corner{p[x_] - origin_[x_] - shear_x_ * z, p[y_] - origin_[y_] - shear_y_ * z, z};
  };
  const Corner p = seen(a), q = seen(b), r = seen(c);
  const double u = r.x * q.y - r.y * q.x, v = p.x * r.y - p.y * r.x, w = q.x * p.y - q.y * p.x;
  // Signs differ. As one branch: which of the six comparisons decides cannot be foreseen.
  if (std::min(std::min(u, v), w) < 0 && std::max(std::max(u, v), w) > 0) return std::nullopt;
  const double determinant = u + v + w;
  if (determinant == 0) return std::nullopt;
  const double t =
      (u * (shear_z_ * p.z) + v * (shear_z_ * q.z) + w * (shear_z_ * r.z)) / determinant;
  if (!(t >= 0 && t <= t_max)) return std::nullopt;
  return RayTriangleHit{t, Vec3(u, v, w) / determinant, determinant > 0};
}

std::optional<RayTriangleHit> ray_triangle(const Ray& ray, const std::array<Vec3, 3>& t,
                                           double t_max = std::numeric_limits<double>::infinity());

}  // namespace tumble
