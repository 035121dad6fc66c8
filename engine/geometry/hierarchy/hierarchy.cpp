#include "engine/geometry/hierarchy/hierarchy.hpp"

#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/geometry/hierarchy/brute_force.hpp"
#include "engine/geometry/hierarchy/hull_tree.hpp"
#include "engine/geometry/hierarchy/obb_tree.hpp"
#include "engine/geometry/hierarchy/sphere_tree.hpp"

namespace tumble {
namespace {

template <class Tree>
std::unique_ptr<Hierarchy> make_tree(std::shared_ptr<const TriangleMesh> mesh,
                                     const TreeOptions& options) {
  return std::make_unique<Tree>(std::move(mesh), options);
}

}  // namespace

Hierarchy::Hierarchy(std::shared_ptr<const TriangleMesh> mesh)
    : mesh_(std::move(mesh)), bounds_(tumble::bounds(*mesh_)) {}

Status Hierarchy::refit(std::shared_ptr<const TriangleMesh> mesh) {
  if (mesh->triangles != mesh_->triangles) {
    return Error{ErrorCode::invalid_argument, "the mesh has other triangles than the hierarchy",
                 "refit", "build a new hierarchy"};
  }
  if (mesh->vertices.size() != mesh_->vertices.size()) {
    return Error{ErrorCode::invalid_argument, "the mesh has another number of vertices", "refit",
                 "build a new hierarchy"};
  }
  mesh_ = std::move(mesh);
  bounds_ = tumble::bounds(*mesh_);
  refit_nodes();
  return {};
}

const std::vector<HierarchyKind>& all_hierarchies() {
  static const std::vector<HierarchyKind> kinds = {
      {"aabb", "binary tree of axis-aligned boxes", make_tree<AabbTree>},
      {"obb", "binary tree of tight boxes with axes of their own", make_tree<ObbTree>},
      {"sphere", "binary tree of minimal spheres", make_tree<SphereTree>},
      {"convex_hull", "binary tree of rounded convex hulls", make_tree<HullTree>},
      {"brute_force", "every triangle every time, to compare with", make_tree<BruteForceHierarchy>},
  };
  return kinds;
}

}  // namespace tumble
