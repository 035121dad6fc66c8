#pragma once
#include "engine/geometry/mesh_topology.hpp"

namespace tumble {

/// Vertices whose triangles do not all hang together over edges at the vertex: cones that meet in
/// their tips. Ascending.
std::vector<uint32_t> non_manifold_vertices(const TriangleMesh& mesh, const MeshTopology& topology);

}  // namespace tumble
