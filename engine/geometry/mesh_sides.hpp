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

/// The edges of a mesh that keep it from bounding a solid, as MeshTopology counts them.
struct EdgeFaults {
  size_t open = 0;          ///< with one face
  size_t non_manifold = 0;  ///< with more than two faces
  size_t misoriented = 0;   ///< with two faces that run the same way
  bool any() const { return open + non_manifold + misoriented > 0; }
};
/// Without the rest of the topology, at a tenth of its time.
EdgeFaults edge_faults(const TriangleMesh& mesh);

}  // namespace tumble
