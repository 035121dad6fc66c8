#pragma once
#include "engine/geometry/triangle_mesh.hpp"

#include <vector>

namespace tumble {

/// One side of one triangle, as vertex numbers low < high.
struct MeshSide {
  uint32_t low, high, face;
  uint8_t k;     ///< from corner k of the face to the next
  bool forward;  ///< the face runs low -> high
};

/// The sides of all triangles by (low, high, face, k): those of one edge stand together. Sides
/// between equal vertex numbers are left out. O(n) but for the sorting around each vertex. Indices
/// are within the mesh.
std::vector<MeshSide> sorted_sides(const TriangleMesh& mesh);

}  // namespace tumble
