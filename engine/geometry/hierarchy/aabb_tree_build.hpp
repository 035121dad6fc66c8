#pragma once
#include "engine/geometry/hierarchy/aabb_tree.hpp"

namespace tumble {

/// The parts of an AabbTree; see there.
struct AabbTreeParts {
  std::vector<AabbTree::Node> nodes;
  std::vector<uint32_t> order;
  int depth = 0;
};

/// Builds over all triangles of a mesh, boxes relative to `origin`.
AabbTreeParts build_aabb_tree(const TriangleMesh& mesh, const Vec3& origin);

}  // namespace tumble
