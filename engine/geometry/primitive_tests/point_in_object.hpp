#pragma once
#include "engine/geometry/hierarchy/hierarchy.hpp"
#include "engine/geometry/primitive_tests/shapes.hpp"

#include <optional>

namespace tumble {

/// Where a point is relative to a closed mesh.
enum class PointSide : uint8_t { outside, boundary, inside };

struct PointInObject {
  PointSide side = PointSide::outside;
  /// How often the surface winds around the point: 1 inside an outward-oriented simple mesh, -1
  /// inside an inside-out one; 0 outside and on the boundary.
  int winding = 0;
};

/// Coutinho 2013 §2.5.14. Exact for the doubles given: the signed crossings of the ray along +X are
/// counted with exact orientations; a ray that grazes edges or vertices is moved symbolically by an
/// infinitesimal along +Y and a smaller one along +Z (simulation of simplicity, Edelsbrunner &
/// Muecke 1990), so that every triangle is met inside or missed. `inside` is a winding number other
/// than zero, so that parts that overlap count as their union. The mesh must be closed (each edge
/// run through as often in either direction: MeshTopology::closed_and_oriented()); of an open one
/// the answer is that of the ray alone. Any kind of hierarchy gives the same answer.
PointInObject point_in_object(const Vec3& p, const Hierarchy& object);

/// How the ray from p along +X, moved as in point_in_object, meets one triangle that does not hold
/// p: 1 leaving through its outer side, -1 entering, 0 not at all. Summed over a closed mesh it is
/// the winding number.
int ray_crossing(const Vec3& p, const Triangle3& t);
/// The same for a whole line along X through these y and z: 1 if it leaves through the triangle's
/// outer side, -1 if it enters, 0 if it misses.
int line_crossing(const Vec2& p, const Triangle3& t);

/// A vertex of one object inside another or on it.
struct VertexContact {
  Vec3 on_vertex = Vec3::Zero();   ///< the vertex, in the object's frame [m]
  Vec3 on_surface = Vec3::Zero();  ///< nearest point of the object's surface [m]
  Vec3 normal = Vec3::UnitY();     ///< unit, outward: the shortest way for the vertex to leave
  double depth = 0;                ///< distance of the two [m]
  uint32_t triangle = no_index;    ///< that holds the surface point
};

/// Coutinho 2013 §2.5.13. The vertex is in the object's frame: a pose is applied (and rounded) by
/// the caller. Nothing when the vertex is outside. On the boundary the normal is the triangle's,
/// for a triangle without area +Y.
std::optional<VertexContact> vertex_in_object(const Vec3& vertex, const Hierarchy& object);

}  // namespace tumble
