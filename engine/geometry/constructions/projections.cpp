#include "engine/geometry/constructions/projections.hpp"

namespace tumble {

std::optional<Plane> plane_through(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = (b - a).cross(c - a);
  const double length = n.norm();
  if (!(length > 0)) return std::nullopt;
  const Vec3 unit = n / length;
  return Plane{unit, unit.dot((a + b + c) / 3)};
}

Vec3 project_on_plane(const Vec3& p, const Plane& plane) {
  return p - plane.distance(p) * plane.normal;
}

Vec3 reject(const Vec3& v, const Vec3& n) {
  return v - v.dot(n) * n;
}

Vec3 project_on_line(const Vec3& p, const Vec3& origin, const Vec3& direction) {
  const double square = direction.squaredNorm();
  if (!(square > 0)) return origin;
  return origin + ((p - origin).dot(direction) / square) * direction;
}

std::optional<double> segment_plane(const Vec3& a, const Vec3& b, const Plane& plane) {
  const double da = plane.distance(a), db = plane.distance(b);
  if (da == 0) return 0.0;
  if (db == 0) return 1.0;
  if ((da > 0) == (db > 0)) return std::nullopt;
  return da / (da - db);
}

}  // namespace tumble
