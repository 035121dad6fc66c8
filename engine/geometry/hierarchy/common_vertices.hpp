#pragma once
#include "engine/geometry/hierarchy/bounding_tree.hpp"

#include <algorithm>

namespace tumble {

/// Vertices of a that are in b; no_index in place of the others.
inline Triangle common_vertices(const Triangle& a, const Triangle& b) {
  Triangle out;
  for (size_t k = 0; k < 3; ++k) {
    out[k] = a[k] == b[0] || a[k] == b[1] || a[k] == b[2] ? a[k] : no_index;
  }
  return out;
}
inline bool any_vertex(const Triangle& t) {
  return t[0] != no_index || t[1] != no_index || t[2] != no_index;
}

/// For each node of a tree the vertices that all its triangles share. Two nodes with such a vertex
/// in common have neighbouring triangles only, which saves a fan of n triangles n^2 pairs that all
/// meet at its tip. Empty for meshes without large fans, which would not benefit.
class CommonVertices {
 public:
  /// Only fans of more triangles count as large.
  static constexpr uint32_t large_fan = 32;

  template <class Nodes>
  CommonVertices(const Nodes& nodes, const TriangleMesh& mesh, std::span<const uint32_t> order) {
    std::vector<uint32_t> count(mesh.vertices.size(), 0);
    uint32_t most = 0;
    for (const Triangle& t : mesh.triangles) {
      for (const uint32_t v : t) most = std::max(most, ++count[v]);
    }
    if (most <= large_fan) return;
    common_.resize(nodes.size());
    fit_upwards(
        nodes,
        [&](uint32_t i, NodeRange range) {
          common_[i] = mesh.triangles[order[range.first]];
          for (uint32_t k = range.first + 1; k < range.last; ++k) {
            common_[i] = common_vertices(common_[i], mesh.triangles[order[k]]);
          }
        },
        [&](uint32_t i, NodeRange) {
          common_[i] = common_vertices(common_[i + 1], common_[nodes[i].start]);
        });
  }

  /// Whether, by a common vertex, every triangle of node i is a neighbour of every one of node j.
  bool neighbours(uint32_t i, uint32_t j) const {
    return !common_.empty() && any_vertex(common_vertices(common_[i], common_[j]));
  }

 private:
  std::vector<Triangle> common_;
};

}  // namespace tumble
