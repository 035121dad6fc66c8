#include "engine/geometry/hierarchy/minimal_sphere.hpp"

#include <array>
#include <cmath>
#include <optional>

namespace tumble {
namespace {

/// The points on the sphere that determine it.
struct Basis {
  std::array<Vec3, 5> points;
  size_t size = 0;
  Basis() { points.fill(Vec3::Zero()); }
};

/// Centre of the smallest sphere through one to four points; empty if they do not determine one
/// (collinear, coplanar).
std::optional<Vec3> centre_through(std::span<const Vec3* const> p) {
  if (p.size() == 1) return *p[0];
  const Vec3 a = *p[1] - *p[0];
  if (p.size() == 2) return *p[0] + 0.5 * a;
  const Vec3 b = *p[2] - *p[0];
  const Vec3 n = a.cross(b);
  const double area = n.squaredNorm();
  if (!(area > 1e-20 * a.squaredNorm() * b.squaredNorm())) return std::nullopt;
  if (p.size() == 3) {
    return *p[0] + (a.squaredNorm() * b.cross(n) + b.squaredNorm() * n.cross(a)) / (2 * area);
  }
  const Vec3 c = *p[3] - *p[0];
  const double volume = n.dot(c);
  if (!(std::fabs(volume) > 1e-10 * std::sqrt(area) * c.norm())) return std::nullopt;
  return *p[0] +
         (c.squaredNorm() * n + b.squaredNorm() * c.cross(a) + a.squaredNorm() * b.cross(c)) /
             (2 * volume);
}

/// The smallest enclosing sphere of at most five points: the smallest sphere of a subset of up to
/// four points that contains the others.
Sphere sphere_about(const Basis& all, Basis& kept) {
  Sphere best;
  best.radius = -1;
  for (unsigned subset = 1; subset < (1u << all.size); ++subset) {
    std::array<const Vec3*, 5> chosen{};
    size_t n = 0;
    for (size_t k = 0; k < all.size; ++k) {
      if (subset >> k & 1) chosen[n++] = &all.points[k];
    }
    if (n > 4) continue;
    const auto centre = centre_through({chosen.data(), n});
    if (!centre) continue;
    double square = 0, own = 0;
    for (size_t k = 0; k < all.size; ++k) {
      const double s = (all.points[k] - *centre).squaredNorm();
      square = std::max(square, s);
      if (subset >> k & 1) own = std::max(own, s);
    }
    // A point outside by more than rounding excludes the sphere.
    if (square > own * (1 + 1e-12)) continue;
    const double radius = std::sqrt(square);
    if (best.radius >= 0 && !(radius < best.radius)) continue;
    best = {*centre, radius};
    kept.size = n;
    for (size_t k = 0; k < n; ++k) kept.points[k] = *chosen[k];
  }
  return best;
}

}  // namespace

Sphere minimal_sphere(std::span<const Vec3> points) {
  Basis basis;
  basis.points[0] = points[0];
  basis.size = 1;
  Sphere sphere{points[0], 0};
  constexpr int most_steps = 200;  // a dozen is usual
  double furthest = 0;
  for (int step = 0; step < most_steps; ++step) {
    const Vec3* pivot = nullptr;
    furthest = 0;
    for (const Vec3& p : points) {
      const double square = (p - sphere.centre).squaredNorm();
      if (!(square > furthest)) continue;
      furthest = square;
      pivot = &p;
    }
    if (!pivot || furthest <= sphere.radius * sphere.radius * (1 + 1e-12)) break;
    Basis grown = basis;
    grown.points[grown.size++] = *pivot;
    const Sphere next = sphere_about(grown, basis);
    if (!(next.radius > sphere.radius)) break;  // no progress beyond rounding
    sphere = next;
  }
  furthest = 0;
  for (const Vec3& p : points) furthest = std::max(furthest, (p - sphere.centre).squaredNorm());
  sphere.radius = std::sqrt(furthest);
  return sphere;
}

}  // namespace tumble
