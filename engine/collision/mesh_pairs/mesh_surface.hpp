#pragma once
#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/geometry/hierarchy/hierarchy_set.hpp"
#include "engine/geometry/mesh_topology.hpp"

#include <memory>
#include <span>
#include <vector>

namespace tumble {

/// Data of a triangulated surface for contacts, built once per shape.
///
/// Only features at which the surface is convex or ends can touch first: convex and open edges, and
/// vertices that are not inside a flat or concave region. The others are inactive, which avoids
/// ghost collisions at the inner edges of a tessellated plane.
struct MeshSurface {
  std::shared_ptr<const TriangleMesh> mesh;
  MeshTopology topology;
  std::unique_ptr<AabbTree> tree;
  std::unique_ptr<HierarchySet> hierarchies;  ///< of other kinds, built on request
  std::vector<uint8_t> edge_active;           ///< convex or open
  std::vector<uint8_t> vertex_active;         ///< has an active edge
  /// Which active corners (bits 0-2) and sides (bits 3-5) each triangle owns: every active vertex
  /// and edge has one owner, so that nothing is tested twice.
  std::vector<uint8_t> owned;
  /// Thickness of the solid behind each face along its normal [m]; the size of the mesh if there is
  /// nothing behind (open meshes).
  std::vector<float> thickness;
  bool closed = false;
  double size = 0;           ///< diagonal of the bounds [m]
  double min_thickness = 0;  ///< least of the faces [m]
  double max_thickness = 0;

  const Vec3& vertex(uint32_t v) const { return mesh->vertices[v]; }
  /// Thickness of the solid behind these faces, measured along `direction` (unit, outward) [m].
  double thickness_along(std::span<const uint32_t> faces, const Vec3& direction) const;
};

/// Builds topology, tree, activity and thickness of a mesh that passed validate().
MeshSurface build_mesh_surface(std::shared_ptr<const TriangleMesh> mesh);

/// The surface whose triangles are turned over.
MeshSurface reversed_surface(const MeshSurface& surface);

}  // namespace tumble
