#pragma once
#include "engine/geometry/primitive_tests/shapes.hpp"

#include <optional>

/// Sphere against sphere, box, triangle and segment (Coutinho 2013 §2.5.4, 2.5.6, 2.5.8, 2.5.9).
/// Yes when the centre is within the radius of the other shape, exactly: the nearest point of the
/// other shape (Ericson 2005 §5.1) decides with a margin nearly always, and where it cannot, the
/// distances of all corners, edges and faces are compared as exact squares. Exact for coordinates
/// and radii that are zero or between 1e-34 and 1e34 in magnitude.
///
/// A contact's normal runs from the sphere (A) to the other shape (B), from the centre to the
/// nearest point. A centre on B, where that has no direction, takes the normal of B's face there
/// (of a triangle its outer side: the sphere leaves that way, so the normal is its opposite), of an
/// edge any direction across it, of a point +Y. A centre inside a box goes out through the nearest
/// face. Depth is the shortest way out; within 1e-12 of the pair's size.
namespace tumble {

bool spheres_intersect(const Sphere& a, const Sphere& b);
std::optional<PrimitiveContact> sphere_sphere_contact(const Sphere& a, const Sphere& b);

bool sphere_box_intersect(const Sphere& sphere, const OrientedBox& box);
bool sphere_box_intersect(const Vec3& centre, double radius, const Aabb& box);
std::optional<PrimitiveContact> sphere_box_contact(const Sphere& sphere, const OrientedBox& box);

bool sphere_triangle_intersect(const Vec3& centre, double radius, const Triangle3& t);
std::optional<PrimitiveContact> sphere_triangle_contact(const Sphere& sphere, const Triangle3& t);

bool segment_sphere_intersect(const Segment& segment, const Sphere& sphere);
/// Here too A is the sphere.
std::optional<PrimitiveContact> segment_sphere_contact(const Segment& segment,
                                                       const Sphere& sphere);

}  // namespace tumble
