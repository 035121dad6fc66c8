#pragma once
#include "engine/collision/mesh_pairs/feature_contacts.hpp"

#include <span>
#include <vector>

namespace tumble {

/// Appends the active edges that a triangle owns.
inline void place_edges(const PlacedSurface& S, uint32_t triangle, std::vector<PlacedEdge>& edges) {
  for (unsigned k = 0; k < 3; ++k)
    if (S.s.owned[triangle] & (8u << k))
      edges.emplace_back(S, S.s.topology.face_edges[triangle][k]);
}

inline bool owns_edges(const MeshSurface& s, uint32_t triangle) {
  return s.owned[triangle] >> 3 != 0;
}

/// The active edges that triangles of one surface own, each placed once.
class OwnedEdges {
 public:
  /// Places the edges of all triangles that are first in a pair; `pairs` is sorted by these.
  void place(const PlacedSurface& S, const std::vector<TriangleIds>& pairs) {
    edges_.clear();
    if (runs_.size() < S.s.owned.size()) runs_.resize(S.s.owned.size());
    for (size_t i = 0; i < pairs.size(); ++i) {
      const uint32_t t = pairs[i].a;
      if (i > 0 && t == pairs[i - 1].a) continue;
      const auto first = uint32_t(edges_.size());
      place_edges(S, t, edges_);
      runs_[t] = {first, uint32_t(edges_.size()) - first};
    }
  }
  bool empty() const { return edges_.empty(); }
  /// For a triangle that is first in a pair.
  std::span<const PlacedEdge> of(uint32_t triangle) const {
    return std::span(edges_).subspan(runs_[triangle].first, runs_[triangle].count);
  }

 private:
  struct Run {
    uint32_t first = 0, count = 0;
  };
  std::vector<PlacedEdge> edges_;
  std::vector<Run> runs_;  ///< by triangle; undefined for those in no pair
};

}  // namespace tumble
