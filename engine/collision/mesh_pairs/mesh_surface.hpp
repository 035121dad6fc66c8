#pragma once
#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/geometry/hierarchy/hierarchy_set.hpp"
#include "engine/geometry/mesh_topology.hpp"

#include <memory>
#include <span>
#include <vector>

namespace tumble {

/// What contacts need to know of a triangulated surface, made once per shape.
///
/// Only features where the surface sticks out can touch first: convex and open edges, and vertices
/// that are not inside a flat or hollow region. The others are inactive, which is what rids
/// contacts of ghost hits at the edges inside a tessellated plane.
struct MeshSurface {
  std::shared_ptr<const TriangleMesh> mesh;
  MeshTopology topology;
  std::unique_ptr<AabbTree> tree;
  std::unique_ptr<HierarchySet> hierarchies;  ///< of other kinds, built when asked for
  std::vector<uint8_t> edge_active;           ///< convex or open
  std::vector<uint8_t> vertex_active;         ///< touches an active edge
  /// Which active corners (bits 0-2) and sides (bits 3-5) each triangle owns: every active vertex
  /// and edge is owned by one triangle, so that nothing is tested twice.
  std::vector<uint8_t> owned;
  /// How deep the solid is behind each face along its normal [m]; the size of the mesh where there
  /// is nothing behind (open meshes).
  std::vector<float> thickness;
  bool closed = false;
  double size = 0;           ///< diagonal of the bounds [m]
  double min_thickness = 0;  ///< of the faces [m]
  double max_thickness = 0;

  const Vec3& vertex(uint32_t v) const { return mesh->vertices[v]; }
  /// How deep the solid is behind these faces, measured along `direction` (unit, outward) [m].
  double thickness_along(std::span<const uint32_t> faces, const Vec3& direction) const;
};

/// Builds topology, tree, activity and thickness of a mesh that passed validate().
MeshSurface build_mesh_surface(std::shared_ptr<const TriangleMesh> mesh);

/// The surface whose triangles are turned over.
MeshSurface reversed_surface(const MeshSurface& surface);

}  // namespace tumble
