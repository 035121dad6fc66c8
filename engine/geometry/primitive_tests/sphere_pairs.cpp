#include "engine/geometry/primitive_tests/sphere_pairs.hpp"

#include "engine/geometry/constructions/closest_points.hpp"
#include "engine/geometry/predicates/filtered.hpp"
#include "engine/geometry/primitive_tests/exact_nearest.hpp"
#include "engine/geometry/primitive_tests/sum_set.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Greatest value of direction.(x - p) over the shape.
double reach(const Segment& s, const Vec3& p, const Vec3& direction) {
  return std::max(direction.dot(s.a - p), direction.dot(s.b - p));
}
double reach(const Triangle3& t, const Vec3& p, const Vec3& direction) {
  return std::max({direction.dot(t[0] - p), direction.dot(t[1] - p), direction.dot(t[2] - p)});
}
double reach(const OrientedBox& b, const Vec3& p, const Vec3& direction) {
  return direction.dot(b.centre - p) + (direction.transpose() * b.half_axes).cwiseAbs().sum();
}

/// Largest absolute coordinate, for bounds of rounding.
double magnitude(const Segment& s) {
  return std::max(s.a.cwiseAbs().maxCoeff(), s.b.cwiseAbs().maxCoeff());
}
double magnitude(const Triangle3& t) {
  return std::max(magnitude(Segment{t[0], t[1]}), t[2].cwiseAbs().maxCoeff());
}
double magnitude(const OrientedBox& b) {
  return b.centre.cwiseAbs().maxCoeff() + b.half_axes.cwiseAbs().sum();
}

Vec3 nearest(const Vec3& p, const Segment& s) {
  return closest_on_segment(p, s.a, s.b).point;
}
Vec3 nearest(const Vec3& p, const Triangle3& t) {
  return closest_on_triangle(p, t[0], t[1], t[2]).point;
}

/// Nearest point of a parallelepiped whose axes are not perpendicular: on its faces, or p itself.
Vec3 nearest_of_faces(const Vec3& p, const OrientedBox& box) {
  const Mat3& h = box.half_axes;
  const Vec3 n0 = h.col(1).cross(h.col(2)), n1 = h.col(2).cross(h.col(0)),
             n2 = h.col(0).cross(h.col(1));
  const double volume = std::fabs(n0.dot(h.col(0)));
  const Vec3 w = p - box.centre;
  if (std::max({std::fabs(n0.dot(w)), std::fabs(n1.dot(w)), std::fabs(n2.dot(w))}) < volume) {
    return p;
  }
  TrianglePoint best;
  best.squared_distance = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const Vec3 u = h.col((k + 1) % 3), v = h.col((k + 2) % 3);
    for (const double side : {-1.0, 1.0}) {
      const Vec3 c = box.centre + side * h.col(k), low = c - u - v, high = c + u + v;
      for (const Vec3& other : {Vec3(c + u - v), Vec3(c - u + v)}) {
        const TrianglePoint q = closest_on_triangle(p, low, other, high);
        if (q.squared_distance < best.squared_distance) best = q;
      }
    }
  }
  return best.point;
}

Vec3 nearest(const Vec3& p, const OrientedBox& box) {
  const Mat3 gram = box.half_axes.transpose() * box.half_axes;
  for (int k = 0; k < 3; ++k) {
    const int j = (k + 1) % 3;
    if (gram(k, j) * gram(k, j) > 1e-28 * gram(k, k) * gram(j, j)) return nearest_of_faces(p, box);
  }
  Vec3 out = box.centre;
  for (int k = 0; k < 3; ++k) {
    if (!(gram(k, k) > 0)) continue;
    const double s = box.half_axes.col(k).dot(p - box.centre) / gram(k, k);
    out += std::clamp(s, -1.0, 1.0) * box.half_axes.col(k);
  }
  return out;
}

template <class Shape>
bool meets(const Sphere& sphere, const Shape& shape) {
  const Vec3& p = sphere.centre;
  const double r = sphere.radius;
  if (!(r >= 0)) return false;
  // Any point of the shape bounds the distance from above, any separating plane from below; 64 u
  // times the largest coordinate covers the rounding of either.
  const Vec3 apart = p - nearest(p, shape);
  const double distance = apart.norm();
  const double doubt = 64 * Estimate::u * (p.cwiseAbs().maxCoeff() + r + magnitude(shape));
  if (distance + doubt < r) return true;
  if (distance > 0 && reach(shape, p, apart / distance) < -(r + doubt)) return false;
  ++exact_fallbacks();
  return within(p, r, features_of(shape)) || contains_origin(difference(p, shape));
}

/// Contact of a sphere with a shape that it touches.
template <class Shape>
PrimitiveContact contact_of(const Sphere& sphere, const Shape& shape) {
  const Vec3& p = sphere.centre;
  PrimitiveContact out;
  const SumSet set = difference(p, shape);
  if (contains_origin(set)) {
    const Penetration inside = penetrations(set).front();
    out.normal = inside.normal;
    out.depth = sphere.radius + inside.depth;
  } else {
    Vec3 offset = p - nearest(p, shape);
    if (offset.norm() < 1e-3 * (p.cwiseAbs().maxCoeff() + magnitude(shape))) {
      offset = accurate_offset(p, features_of(shape));
    }
    const double distance = offset.stableNorm();
    out.normal = -offset / distance;
    out.depth = std::max(sphere.radius - distance, 0.0);
  }
  out.on_a = p + sphere.radius * out.normal;
  out.on_b = p + (sphere.radius - out.depth) * out.normal;
  return out;
}

}  // namespace

bool spheres_intersect(const Sphere& a, const Sphere& b) {
  if (!(a.radius >= 0) || !(b.radius >= 0)) return false;
  const auto excess = [&](auto number) {
    using T = decltype(number);
    const auto between = exact_difference<T>(a.centre, b.centre);
    const T reach = T::sum(a.radius, b.radius);
    return between.dot(between) - reach * reach;
  };
  return exact_sign(excess) <= 0;
}

std::optional<PrimitiveContact> sphere_sphere_contact(const Sphere& a, const Sphere& b) {
  if (!spheres_intersect(a, b)) return std::nullopt;
  const Vec3 between = b.centre - a.centre;
  const double distance = between.stableNorm();
  PrimitiveContact out;
  if (distance > 0) out.normal = between / distance;
  out.depth = std::max(a.radius + b.radius - distance, 0.0);
  out.on_a = a.centre + a.radius * out.normal;
  out.on_b = b.centre - b.radius * out.normal;
  return out;
}

bool sphere_box_intersect(const Sphere& sphere, const OrientedBox& box) {
  return meets(sphere, box);
}

bool sphere_box_intersect(const Vec3& centre, double radius, const Aabb& box) {
  if (box.empty() || !(radius >= 0)) return false;
  const Vec3 nearest = centre.cwiseMax(box.min).cwiseMin(box.max);
  const auto excess = [&](auto number) {
    using T = decltype(number);
    const auto between = exact_difference<T>(centre, nearest);
    return between.dot(between) - T::product(radius, radius);
  };
  return exact_sign(excess) <= 0;
}

std::optional<PrimitiveContact> sphere_box_contact(const Sphere& sphere, const OrientedBox& box) {
  if (!meets(sphere, box)) return std::nullopt;
  return contact_of(sphere, box);
}

bool sphere_triangle_intersect(const Vec3& centre, double radius, const Triangle3& t) {
  return meets(Sphere{centre, radius}, t);
}

std::optional<PrimitiveContact> sphere_triangle_contact(const Sphere& sphere, const Triangle3& t) {
  if (!meets(sphere, t)) return std::nullopt;
  PrimitiveContact out = contact_of(sphere, t);
  // A sphere centred on the triangle is pushed out on the triangle's outer side.
  const bool centred = out.depth >= sphere.radius;
  if (centred && out.normal.dot((t[1] - t[0]).cross(t[2] - t[0])) > 0) {
    out.normal = -out.normal;
    out.on_a = sphere.centre + sphere.radius * out.normal;
  }
  return out;
}

bool segment_sphere_intersect(const Segment& segment, const Sphere& sphere) {
  return meets(sphere, segment);
}

std::optional<PrimitiveContact> segment_sphere_contact(const Segment& segment,
                                                       const Sphere& sphere) {
  if (!meets(sphere, segment)) return std::nullopt;
  return contact_of(sphere, segment);
}

}  // namespace tumble
