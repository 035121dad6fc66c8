#pragma once
// What each shape is, said a second time and from its definition alone, for tests to compare with:
// one case a shape in level() and extent_along().
#include "engine/collision/shape.hpp"
#include "engine/core/random.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble::test {

/// A convex function of the point that is negative in the solid and positive outside (not a
/// distance); of shapes that are said by numbers.
inline double level(const ShapeDef& s, const Vec3& p) {
  const double across = std::hypot(p.x(), p.z());
  switch (s.type) {
    case ShapeType::sphere:
      return p.norm() - s.radius;
    case ShapeType::capsule:
      return std::hypot(across, std::max(0.0, std::fabs(p.y()) - 0.5 * s.height)) - s.radius;
    case ShapeType::cylinder:
      return std::max(across - s.radius, std::fabs(p.y()) - 0.5 * s.height);
    case ShapeType::box:
      return (p.cwiseAbs() - s.half_extents).maxCoeff();
    case ShapeType::ellipsoid:
      return p.cwiseQuotient(s.half_extents).norm() - 1;
    case ShapeType::half_space:
      return p.y();
    case ShapeType::cone:
      return std::max(-0.5 * s.height - p.y(), across - s.radius * (0.5 - p.y() / s.height));
    case ShapeType::tapered_capsule: {
      // In one of the balls whose radii run evenly from end to end: the best one by sections.
      const auto in_ball = [&](double share) {
        const double y = (share - 0.5) * s.height;
        return std::hypot(across, p.y() - y) - s.radius - share * (s.top_radius - s.radius);
      };
      double lo = 0, hi = 1;
      for (int k = 0; k < 100; ++k) {
        const double a = hi - 0.6 * (hi - lo), b = lo + 0.6 * (hi - lo);
        in_ball(a) < in_ball(b) ? hi = b : lo = a;
      }
      return in_ball(0.5 * (lo + hi));
    }
    default:
      return std::numeric_limits<double>::quiet_NaN();
  }
}

/// The furthest extent of a shape along a unit vector of its own frame [m].
inline double extent_along(const ShapeDef& s, const Vec3& n) {
  const double across = std::sqrt(n.x() * n.x() + n.z() * n.z());
  switch (s.type) {
    case ShapeType::sphere:
      return s.radius;
    case ShapeType::capsule:
      return s.radius + 0.5 * s.height * std::fabs(n.y());
    case ShapeType::cylinder:
      return s.radius * across + 0.5 * s.height * std::fabs(n.y());
    case ShapeType::box:
      return s.half_extents.dot(n.cwiseAbs());
    case ShapeType::ellipsoid:
      return s.half_extents.cwiseProduct(n).norm();
    case ShapeType::half_space:
      return n.y() > 1 - 1e-12 ? 0 : std::numeric_limits<double>::infinity();
    case ShapeType::cone:
      return std::max(0.5 * s.height * n.y(), s.radius * across - 0.5 * s.height * n.y());
    case ShapeType::tapered_capsule:
      return std::max(s.radius - 0.5 * s.height * n.y(), s.top_radius + 0.5 * s.height * n.y());
    default: {
      double most = -std::numeric_limits<double>::infinity();
      for (const Vec3& v : s.mesh->vertices) most = std::max(most, n.dot(v));
      return most;
    }
  }
}

/// Distance along a unit ray from outside to the solid by its level: infinite where it misses. The
/// least level on the ray by sections, then where it falls below zero (1e-12 of the way).
inline double ray_by_level(const ShapeDef& s, const Vec3& from, const Vec3& unit) {
  const auto at = [&](double t) { return level(s, from + t * unit); };
  double lo = 0, hi = 2 * from.norm() + 10;
  for (int k = 0; k < 200; ++k) {
    const double a = hi - 0.6 * (hi - lo), b = lo + 0.6 * (hi - lo);
    at(a) < at(b) ? hi = b : lo = a;
  }
  double in = 0.5 * (lo + hi), out = 0;
  if (!(at(in) < 0)) return std::numeric_limits<double>::infinity();
  for (int k = 0; k < 100; ++k) {
    const double t = 0.5 * (in + out);
    (at(t) < 0 ? in : out) = t;
  }
  return 0.5 * (in + out);
}

/// Signed distance to a solid that is round about y: the best of all planes that part the point
/// from it, n.p - extent(n), whose normals are in the plane of the axis and the point. Inside it is
/// that of the nearest plane.
inline double distance_by_planes(const ShapeDef& s, const Vec3& p) {
  const double across = std::hypot(p.x(), p.z());
  const auto apart = [&](double angle) {
    return across * std::cos(angle) + p.y() * std::sin(angle) -
           extent_along(s, {std::cos(angle), std::sin(angle), 0});
  };
  const double step = std::acos(-1.0) / 400;
  double best = 0;
  for (int k = -200; k <= 200; ++k)
    if (apart(k * step) > apart(best)) best = k * step;
  double lo = best - step, hi = best + step;
  for (int k = 0; k < 100; ++k) {
    const double a = hi - 0.6 * (hi - lo), b = lo + 0.6 * (hi - lo);
    apart(a) > apart(b) ? hi = b : lo = a;
  }
  return std::max(apart(best), apart(0.5 * (lo + hi)));
}

/// A shape of this type with random sizes about a third of a metre; of those said by numbers.
inline ShapeDef draw_def(Random& r, const ShapeEntry& entry) {
  ShapeDef def;
  def.type = entry.type;
  for (const ShapeParameter& p : entry.parameters) {
    if (p.number) def.*p.number = r.uniform(0.2, 0.5);
    if (p.vector)
      for (int k = 0; k < 3; ++k) (def.*p.vector)[k] = r.uniform(0.15, 0.5);
  }
  if (!make_shape(def)) return draw_def(r, entry);  // contradictions of sizes
  return def;
}

}  // namespace tumble::test
