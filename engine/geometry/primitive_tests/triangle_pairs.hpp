#pragma once
#include "engine/geometry/primitive_tests/shapes.hpp"

#include <cstdint>
#include <optional>

/// Triangle against triangle, segment and point, and edge against edge (Coutinho 2013 §2.5.5,
/// 2.5.10, 2.5.12, 2.5.13), by exact orientations: the doubles given are answered as real numbers
/// would, touching counts as yes. Exact for coordinates that are zero or between 1e-80 and 1e80 in
/// magnitude; the contacts are within 1e-12 of the pair's size from 1e-30 to 1e30.
namespace tumble {

/// Guigue & Devillers, "Fast and Robust Triangle-Triangle Overlap Test Using Orientation
/// Predicates" (2003) for two triangles that cross each other's plane; coplanar ones and those
/// without area by their sides and containment.
bool triangles_intersect(const Triangle3& a, const Triangle3& b);
/// Nothing when they do not meet. Two triangles in one plane have depth 0 along its normal.
std::optional<PrimitiveContact> triangle_triangle_contact(const Triangle3& a, const Triangle3& b);

/// How two triangles lie to each other, weakest first.
enum class TriangleRelation : uint8_t {
  apart,        ///< no point in common
  touching,     ///< points in common, but none inside both
  overlapping,  ///< in one plane, with an area in common
  crossing,     ///< each passes through the inside of the other
};
/// Exact, as triangles_intersect. Triangles without area have no inside: they touch or are apart.
TriangleRelation triangle_relation(const Triangle3& a, const Triangle3& b);

bool segment_triangle_intersect(const Vec3& p, const Vec3& q, const Triangle3& t);
/// A is the segment. Nothing when they do not meet.
std::optional<PrimitiveContact> segment_triangle_contact(const Segment& s, const Triangle3& t);

/// Edge against edge: whether segments a-b and c-d have a point in common.
bool segments_intersect(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
/// The common point (the first along `a` of many), the unit normal of the plane of the two (any
/// across them when they lie on one line), depth 0. Nothing when they do not meet.
std::optional<PrimitiveContact> edge_edge_contact(const Segment& a, const Segment& b);

/// In the triangle's plane, inside or on its border.
bool point_in_triangle(const Vec3& p, const Triangle3& t);

}  // namespace tumble
