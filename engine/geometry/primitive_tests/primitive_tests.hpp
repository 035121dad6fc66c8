#pragma once
#include "engine/math/types.hpp"

#include <array>

/// Yes or no for pairs of simple shapes; touching counts as yes.
namespace tumble {

/// Whether segment p-q and triangle t have a point in common: exact for the doubles given, also
/// coplanar, touching and for triangles without area.
bool segment_triangle_intersect(const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& t);

/// Whether two segments have a point in common: exact.
bool segments_intersect(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Whether two triangles have a point in common: exact, by exact orientation of segments against
/// the other triangle; coplanar ones also by containment.
bool triangles_intersect(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

/// Whether p lies in a triangle (in its plane, inside or on its border): exact.
bool point_in_triangle(const Vec3& p, const std::array<Vec3, 3>& t);

/// A box with its own axes: centre and three half-axis vectors.
struct OrientedBox {
  Vec3 centre = Vec3::Zero();
  Mat3 half_axes = Mat3::Identity();  ///< columns, mutually perpendicular; a column may be zero
};

/// Separating axes (Gottschalk, Lin & Manocha 1996): six face normals, nine edge pairs. Rounding
/// may decide contacts within 1e-15 of the boxes' size.
bool boxes_intersect(const OrientedBox& a, const OrientedBox& b);

/// Separating axes (Akenine-Moeller 2001): three box normals, the triangle's, nine edge pairs; same
/// rounding.
bool box_triangle_intersect(const Aabb& box, const std::array<Vec3, 3>& t);

bool sphere_box_intersect(const Vec3& centre, double radius, const Aabb& box);
bool sphere_triangle_intersect(const Vec3& centre, double radius, const std::array<Vec3, 3>& t);
bool segment_box_intersect(const Vec3& p, const Vec3& q, const Aabb& box);

}  // namespace tumble
