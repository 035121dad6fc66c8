#pragma once
#include "engine/math/types.hpp"

#include <array>
#include <cstdint>

namespace tumble {

/// A corner, a side or the inside of a triangle. Side k runs from corner k to corner k + 1.
enum class TriangleFeature : uint8_t { vertex0, vertex1, vertex2, edge0, edge1, edge2, face };

constexpr bool is_vertex(TriangleFeature f) {
  return f <= TriangleFeature::vertex2;
}
constexpr bool is_edge(TriangleFeature f) {
  return f >= TriangleFeature::edge0 && f <= TriangleFeature::edge2;
}
/// Number of the corner or the side: 0, 1, 2; 0 for the face.
constexpr unsigned feature_index(TriangleFeature f) {
  return f == TriangleFeature::face ? 0u : unsigned(f) % 3u;
}

/// Nearest point of a segment.
struct SegmentPoint {
  Vec3 point = Vec3::Zero();
  double s = 0;  ///< in [0, 1], point = a + s (b - a)
};
/// A segment whose ends coincide gives s = 0.
SegmentPoint closest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b);

/// Nearest points of two things, one on each.
struct ClosestPair {
  Vec3 on_a = Vec3::Zero();
  Vec3 on_b = Vec3::Zero();
  double squared_distance = 0;  ///< [m^2]
};

/// Nearest points of two segments (Ericson 2005 §5.1.9, with clamping): parameters in [0, 1].
/// Parallel overlapping segments have many answers: the one with the smallest s of segment A.
/// A segment of no length is a point.
struct SegmentPair : ClosestPair {
  double s = 0;  ///< on segment a0-a1
  double t = 0;  ///< on segment b0-b1
};
SegmentPair closest_segment_segment(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1);

/// Nearest points of the infinite line through `origin` along `direction` (any length) and a
/// segment (Coutinho 2013 §6.5); s is measured in `direction` and unbounded, t in [0, 1]. A line
/// parallel to the segment takes the segment's first end; a zero direction makes the line a point.
SegmentPair closest_line_segment(const Vec3& origin, const Vec3& direction, const Vec3& b0,
                                 const Vec3& b1);

/// Nearest point of a triangle (Ericson 2005 §5.1.5), with the feature that holds it.
struct TrianglePoint {
  Vec3 point = Vec3::Zero();
  Vec3 barycentric = Vec3::UnitX();  ///< weights of the three corners, each in [0, 1], sum 1
  TriangleFeature feature = TriangleFeature::vertex0;
  double squared_distance = 0;  ///< [m^2]
};
/// A triangle without area is the nearest of its three sides; its feature is never `face`.
TrianglePoint closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// Nearest points of segment (on_a) and triangle (on_b). Intersecting ones give distance 0 and a
/// common point.
ClosestPair closest_segment_triangle(const Vec3& s0, const Vec3& s1, const std::array<Vec3, 3>& t);

/// Nearest points of two triangles: nine pairs of sides and six of corner and face. Intersecting
/// ones give distance 0 and a common point.
struct TrianglePair : ClosestPair {
  TriangleFeature feature_a = TriangleFeature::vertex0;
  TriangleFeature feature_b = TriangleFeature::vertex0;
};
TrianglePair closest_triangle_triangle(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

}  // namespace tumble
