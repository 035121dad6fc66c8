#pragma once
#include "engine/geometry/hierarchy/triangle_decisions.hpp"
#include "engine/geometry/primitive_tests/triangle_pairs.hpp"

#include <vector>

namespace tumble {

/// Two triangles of one mesh with more in common than the corners that they share.
struct TriangleClash {
  TriangleIds ids;  ///< a < b
  TriangleRelation relation = TriangleRelation::touching;
  bool same_facing = false;  ///< overlapping ones: both normals point to the same side
};

/// All of them, ascending, decided exactly. Corners at equal positions count as shared. Triangles
/// without area are left out. When more than `star_limit` pairs meet around one vertex that cannot
/// be excluded cheaply, those beyond are not looked at and `crowded` takes the vertex.
std::vector<TriangleClash> self_intersections(const TriangleMesh& mesh,
                                              std::vector<uint32_t>* crowded = nullptr,
                                              size_t star_limit = 4'000'000);

/// For each vertex the lowest one at the same position (-0 equals 0).
std::vector<uint32_t> lowest_equal_vertices(const TriangleMesh& mesh);

}  // namespace tumble
