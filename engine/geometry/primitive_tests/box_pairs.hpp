#pragma once
#include "engine/geometry/primitive_tests/shapes.hpp"

#include <optional>

/// Box against box, triangle and segment (Coutinho 2013 §2.5.3, 2.5.7, 2.5.11), by separating axes
/// of the difference of the two (Gottschalk, Lin & Manocha 1996; Akenine-Moeller 2001) with exact
/// signs: the doubles given are answered as real numbers would, touching counts as yes. Exact for
/// coordinates that are zero or between 1e-59 and 1e59 in magnitude; the contacts are within 1e-12
/// of the pair's size from 1e-30 to 1e30. An empty Aabb meets nothing.
namespace tumble {

bool boxes_intersect(const OrientedBox& a, const OrientedBox& b);
/// Nothing when they do not meet. Depths that tie go to the faces of A, then of B, then edges.
std::optional<PrimitiveContact> box_box_contact(const OrientedBox& a, const OrientedBox& b);

bool box_triangle_intersect(const OrientedBox& box, const Triangle3& t);
bool box_triangle_intersect(const Aabb& box, const Triangle3& t);
std::optional<PrimitiveContact> box_triangle_contact(const OrientedBox& box, const Triangle3& t);

bool segment_box_intersect(const Segment& s, const OrientedBox& box);
bool segment_box_intersect(const Vec3& p, const Vec3& q, const Aabb& box);
/// A is the segment.
std::optional<PrimitiveContact> segment_box_contact(const Segment& s, const OrientedBox& box);

bool point_in_box(const Vec3& p, const OrientedBox& box);

}  // namespace tumble
