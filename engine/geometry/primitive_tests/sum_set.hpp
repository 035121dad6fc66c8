#pragma once
#include "engine/geometry/primitive_tests/shapes.hpp"

#include <vector>

namespace tumble {

/// A vector that two doubles per coordinate hold exactly: high + low.
struct ExactVector {
  Vec3 high = Vec3::Zero(), low = Vec3::Zero();
};

/// Twice the difference A - B = {a - b} of two shapes, each a point, segment, triangle or box:
///   { offset + sum s_k arm_k + a point each of the triangles (0, side0, side1) : |s_k| <= 1 }
/// A and B have a point in common exactly when this set holds the origin. It is twice the
/// difference so that middles of segments and of aligned boxes need no rounding.
struct SumSet {
  std::array<Vec3, 2> twice_a{}, twice_b{};  ///< offset = sum of twice_a - sum of twice_b
  std::array<ExactVector, 6> arms;
  int arm_count = 0;
  std::array<std::array<ExactVector, 2>, 2> triangles;
  int triangle_count = 0;

  /// The offset rounded.
  Vec3 offset() const { return (twice_a[0] - twice_b[0]) + (twice_a[1] - twice_b[1]); }
};

/// Which of the two shapes is added to a SumSet.
enum class Part { a, b };
void add(SumSet& set, Part part, const Vec3& point);
void add(SumSet& set, Part part, const Segment& segment);
void add(SumSet& set, Part part, const Triangle3& triangle);
void add(SumSet& set, Part part, const OrientedBox& box);
void add(SumSet& set, Part part, const Aabb& box);  ///< not empty

template <class A, class B>
SumSet difference(const A& a, const B& b) {
  SumSet out;
  add(out, Part::a, a);
  add(out, Part::b, b);
  return out;
}

/// Exact for coordinates that are zero or between 1e-59 and 1e59 in magnitude. The set is a
/// polytope whose edges run along the arms and the triangles' sides, so its facets are normal to
/// cross products of two of these: every such axis is tried (for two boxes the fifteen of
/// Gottschalk, Lin & Manocha 1996, with cross products of axes as face normals since the axes need
/// not be perpendicular). A set without volume lies in a plane or on a line: then also the axes
/// within it.
bool contains_origin(const SumSet& set);

/// Direction n in which the origin is nearest to the border of a set that contains it, from A to
/// B, and how far that is. A set without volume has depth 0 and a normal across it.
struct Penetration {
  Vec3 normal = Vec3::UnitY();
  double depth = 0;  ///< of A and B (not doubled) [m]
};
/// All directions whose depths are the least within 1e-14 of the set's size, faces before edges;
/// at least one. The axes are computed in doubled precision where their factors are nearly
/// parallel.
std::vector<Penetration> penetrations(const SumSet& set);

}  // namespace tumble
