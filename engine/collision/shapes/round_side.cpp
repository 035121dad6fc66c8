#include "engine/collision/shapes/round_side.hpp"

#include "engine/math/det/det.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {

RayHit hit_from_inside(const Ray& ray) {
  const double length = ray.direction.norm();
  return {0, length > 0 ? Vec3(-ray.direction / length) : Vec3(Vec3::Zero())};
}

std::optional<RayHit> ray_cone_side(const ConeSide& side, const Ray& ray, double t_max) {
  const Vec3& d = ray.direction;
  const double length2 = d.squaredNorm();
  if (!(length2 > 0)) return std::nullopt;
  // From the point of the ray nearest to the middle: accurate for distant origins.
  const Vec3 middle(0, 0.5 * (side.y0 + side.y1), 0);
  const double shift = d.dot(middle - ray.origin) / length2;
  const Vec3 o = ray.origin + shift * d;
  // x^2 + z^2 = R(y)^2 with R(y) = r0 + slope (y - y0).
  const double slope = (side.r1 - side.r0) / (side.y1 - side.y0);
  const double R = side.r0 + slope * (o.y() - side.y0);
  const double a = d.x() * d.x() + d.z() * d.z() - slope * slope * d.y() * d.y();
  const double b = o.x() * d.x() + o.z() * d.z() - slope * R * d.y();
  const double c = o.x() * o.x() + o.z() * o.z() - R * R;
  const double discriminant = b * b - a * c;
  if (discriminant < 0) return std::nullopt;
  const double q = b < 0 ? std::sqrt(discriminant) - b : -std::sqrt(discriminant) - b;
  std::array<double, 2> times{a != 0 ? q / a : 0, q != 0 ? c / q : 0};
  std::sort(times.begin(), times.end());
  const double slack = 1e-12 * (side.y1 - side.y0 + std::max(side.r0, side.r1));
  for (const double t : times) {
    const double time = shift + t;
    if (!std::isfinite(time) || time < 0 || time > t_max) continue;
    const Vec3 p = o + t * d;
    const double radius = side.r0 + slope * (p.y() - side.y0);
    if (p.y() < side.y0 - slack || p.y() > side.y1 + slack || radius < -slack) continue;
    Vec3 n(p.x(), -slope * radius, p.z());
    const double size = n.norm();
    n = size > 0 ? Vec3(n / size) : Vec3(slope < 0 ? Vec3::UnitY() : Vec3(-Vec3::UnitY()));
    if (n.dot(d) < 0) return RayHit{time, n};
  }
  return std::nullopt;
}

DrawnSurface turned_surface(std::span<const ProfilePoint> profile, uint32_t around) {
  DrawnSurface out;
  for (const ProfilePoint& p : profile)
    for (uint32_t i = 0; i < around; ++i) {
      const double angle = 2 * det::pi * i / around;
      const double c = det::cos(angle), s = det::sin(angle);
      out.positions.emplace_back(p.radius * c, p.y, p.radius * s);
      out.normals.emplace_back(p.normal_out * c, p.normal_y, p.normal_out * s);
    }
  for (uint32_t ring = 0; ring + 1 < profile.size(); ++ring)
    for (uint32_t i = 0; i < around; ++i) {
      const uint32_t j = (i + 1) % around, lower = ring * around, upper = lower + around;
      for (const uint32_t k : {lower + i, upper + i, upper + j, lower + i, upper + j, lower + j})
        out.indices.push_back(k);
    }
  return out;
}

}  // namespace tumble
