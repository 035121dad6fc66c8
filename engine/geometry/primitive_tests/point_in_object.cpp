#include "engine/geometry/primitive_tests/point_in_object.hpp"

#include "engine/geometry/predicates/orientation.hpp"
#include "engine/geometry/primitive_tests/triangle_pairs.hpp"

#include <limits>
#include <vector>

namespace tumble {
namespace {

Vec2 shadow(const Vec3& p) {
  return {p.y(), p.z()};
}

}  // namespace

/// Winding number of the triangle's projection along X about p, which is perturbed symbolically:
/// sides that run upward in z with p on their left count 1, those that run downward with p on their
/// right -1. Half-open intervals and strict signs give a side the same answer in both of its
/// triangles.
int line_crossing(const Vec2& p, const Triangle3& t) {
  int winding = 0;
  for (size_t k = 0; k < 3; ++k) {
    const Vec3 &a = t[k], &b = t[(k + 1) % 3];
    const bool below_a = a.z() <= p.y(), below_b = b.z() <= p.y();
    if (below_a == below_b) continue;
    const int side = orientation(shadow(a), shadow(b), p);
    if (below_a && side > 0) ++winding;
    if (below_b && side < 0) --winding;
  }
  return winding;
}

int ray_crossing(const Vec3& p, const Triangle3& t) {
  const int turns = line_crossing(shadow(p), t);
  // The projection is counter-clockwise if the outer side faces +X: the ray leaves there. It meets
  // the triangle ahead of p if p is on the inner side of the plane.
  return turns != 0 && orientation(t[0], t[1], t[2], p) == -turns ? turns : 0;
}

PointInObject point_in_object(const Vec3& p, const Hierarchy& object) {
  PointInObject out;
  Aabb ray{p, p};
  ray.max.x() = object.bounds().max.x();
  if (!object.bounds().contains(p)) return out;
  std::vector<uint32_t> candidates;
  object.overlap(ray, candidates);
  int winding = 0;
  for (uint32_t id : candidates) {
    const auto& mesh = object.mesh();
    const Triangle3 t{mesh.corner(id, 0), mesh.corner(id, 1), mesh.corner(id, 2)};
    if (triangle_bounds(mesh, id).contains(p) && point_in_triangle(p, t)) {
      out.side = PointSide::boundary;
      return out;
    }
    winding += ray_crossing(p, t);
  }
  out.winding = winding;
  if (winding != 0) out.side = PointSide::inside;
  return out;
}

std::optional<VertexContact> vertex_in_object(const Vec3& vertex, const Hierarchy& object) {
  const PointSide side = point_in_object(vertex, object).side;
  if (side == PointSide::outside) return std::nullopt;
  const auto near = object.closest(vertex, std::numeric_limits<double>::infinity());
  if (!near) return std::nullopt;
  VertexContact out{vertex, near->point, Vec3::UnitY(), 0, near->triangle};
  const Vec3 way = near->point - vertex, face = face_normal(object.mesh(), near->triangle);
  if (side == PointSide::inside) out.depth = way.norm();
  if (out.depth > 0) {
    out.normal = way / out.depth;
  } else if (!face.isZero(0)) {
    out.normal = face;
  }
  return out;
}

}  // namespace tumble
