#include "engine/geometry/constructions/ray_casts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tumble {
namespace {

RayHit inside_hit(const Ray& ray) {
  const double length = ray.direction.norm();
  return {0, length > 0 ? Vec3(-ray.direction / length) : Vec3(Vec3::Zero())};
}

/// The part of a ray inside a convex solid, clipped by one boundary after the other; records the
/// normal at the entry.
struct Interval {
  double t0 = -std::numeric_limits<double>::infinity();
  double t1 = std::numeric_limits<double>::infinity();
  Vec3 normal = Vec3::Zero();
  bool empty = false;

  void enter(double t, const Vec3& n) {
    if (t > t0) {
      t0 = t;
      normal = n;
    }
  }
  void leave(double t) { t1 = std::min(t1, t); }

  /// Clips to the half space n.x <= offset. n need not be a unit vector for the interval, but must
  /// be for the normal.
  void clip(const Ray& ray, const Vec3& n, double offset) {
    const double height = n.dot(ray.origin) - offset, rate = n.dot(ray.direction);
    if (rate < 0) {
      enter(-height / rate, n);
    } else if (rate > 0) {
      leave(-height / rate);
    } else if (height > 0) {
      empty = true;
    }
  }

  std::optional<RayHit> hit(const Ray& ray, double t_max) const {
    if (empty || t0 > t1 || t1 < 0 || t0 > t_max) return std::nullopt;
    if (t0 < 0) {
      // The origin is inside; a ray that starts on the surface and leaves is a miss.
      if (t1 <= 0) return std::nullopt;
      return inside_hit(ray);
    }
    return RayHit{t0, normal};
  }
};

/// Clips to the infinite cylinder about Y.
void clip_round(Interval& interval, const Ray& ray, double radius) {
  const double dx = ray.direction.x(), dz = ray.direction.z();
  const double ox = ray.origin.x(), oz = ray.origin.z();
  const double a = dx * dx + dz * dz, b = ox * dx + oz * dz;
  const double c = ox * ox + oz * oz - radius * radius;
  if (!(a > 0)) {
    if (c > 0) interval.empty = true;
    return;
  }
  const double px = ox - b / a * dx, pz = oz - b / a * dz;
  const double discriminant = a * (radius * radius - (px * px + pz * pz));
  if (discriminant < 0) {
    interval.empty = true;
    return;
  }
  const double root = std::sqrt(discriminant);
  const double q = b < 0 ? root - b : -root - b;  // no cancellation
  double t0 = q != 0 ? c / q : 0, t1 = q / a;
  if (t0 > t1) std::swap(t0, t1);
  Vec3 n(ox + t0 * dx, 0, oz + t0 * dz);
  const double length = n.norm();
  interval.enter(t0, length > 0 ? Vec3(n / length) : Vec3(Vec3::UnitX()));
  interval.leave(t1);
}

}  // namespace

std::optional<RayHit> ray_half_space(const Ray& ray, const Plane& plane, double t_max) {
  Interval interval;
  if (ray.direction.isZero(0)) {
    if (plane.distance(ray.origin) > 0) return std::nullopt;
    return inside_hit(ray);
  }
  interval.clip(ray, plane.normal, plane.offset);
  return interval.hit(ray, t_max);
}

std::optional<RayHit> ray_sphere(const Ray& ray, const Vec3& centre, double radius, double t_max) {
  const Vec3 m = ray.origin - centre;
  const double c = m.squaredNorm() - radius * radius;
  const double a = ray.direction.squaredNorm(), b = m.dot(ray.direction);
  if (c < 0) return inside_hit(ray);
  if (!(a > 0) || b >= 0) return std::nullopt;
  // From the foot of the perpendicular (Haines et al. 2019), which is accurate for distant origins.
  const Vec3 foot = m - (b / a) * ray.direction;
  const double discriminant = a * (radius * radius - foot.squaredNorm());
  if (discriminant < 0) return std::nullopt;
  const double t = c / (std::sqrt(discriminant) - b);
  if (t > t_max) return std::nullopt;
  const Vec3 n = m + t * ray.direction;
  const double length = n.norm();
  return RayHit{t, length > 0 ? Vec3(n / length) : Vec3(Vec3::UnitY())};
}

std::optional<RayHit> ray_box(const Ray& ray, const Vec3& half, double t_max) {
  Interval interval;
  for (int k = 0; k < 3; ++k) {
    interval.clip(ray, Vec3::Unit(k), half[k]);
    interval.clip(ray, -Vec3::Unit(k), half[k]);
  }
  return interval.hit(ray, t_max);
}

std::optional<RayHit> ray_cylinder(const Ray& ray, double half_height, double radius,
                                   double t_max) {
  Interval interval;
  clip_round(interval, ray, radius);
  interval.clip(ray, Vec3::UnitY(), half_height);
  interval.clip(ray, -Vec3::UnitY(), half_height);
  return interval.hit(ray, t_max);
}

std::optional<RayHit> ray_capsule(const Ray& ray, double half_height, double radius, double t_max) {
  // A capsule is the union of two balls and a cylinder: the ray enters it where it enters the first
  // of them.
  std::optional<RayHit> best = ray_cylinder(ray, half_height, radius, t_max);
  for (const double y : {half_height, -half_height}) {
    const auto hit = ray_sphere(ray, Vec3(0, y, 0), radius, t_max);
    if (hit && (!best || hit->t < best->t)) best = hit;
  }
  return best;
}

std::optional<RayHit> ray_convex(const Ray& ray, const Plane* planes, size_t count, double t_max) {
  Interval interval;
  for (size_t i = 0; i < count; ++i) interval.clip(ray, planes[i].normal, planes[i].offset);
  return interval.hit(ray, t_max);
}

RayShear::RayShear(const Ray& ray) : origin_(ray.origin) {
  const Vec3& d = ray.direction;
  const double x = std::fabs(d.x()), y = std::fabs(d.y()), z = std::fabs(d.z());
  // The axis of the longest component, computed without branches, since random rays would be
  // mispredicted.
  const int last = z > std::max(x, y);
  z_ = 2 * last + (1 - last) * (y > x);
  valid_ = d[z_] != 0 && d.allFinite() && ray.origin.allFinite();
  if (!valid_) return;
  constexpr std::array<int, 4> after = {1, 2, 0, 1};
  const int backward = d[z_] < 0;  // swaps the other two axes, which preserves the winding
  x_ = after[size_t(z_ + backward)];
  y_ = after[size_t(z_ + 1 - backward)];
  shear_x_ = d[x_] / d[z_];
  shear_y_ = d[y_] / d[z_];
  shear_z_ = 1 / d[z_];
}

std::optional<RayTriangleHit> ray_triangle(const Ray& ray, const std::array<Vec3, 3>& t,
                                           double t_max) {
  return RayShear(ray).triangle(t[0], t[1], t[2], t_max);
}

}  // namespace tumble
