#include "engine/geometry/hierarchy/hull_tree.hpp"

#include "engine/geometry/hierarchy/bounding_tree_distance.hpp"
#include "engine/geometry/hierarchy/bounding_tree_pairs.hpp"
#include "engine/geometry/hierarchy/bounding_tree_queries.hpp"

#include <algorithm>

namespace tumble {

template class BoundingTree<HullKind>;

namespace {

/// Nodes with at most this many vertices keep all of them.
constexpr size_t keep_all = 16;

/// Half of the 26 directions; the others are opposite to these.
const std::array<Vec3, 13>& hull_directions() {
  static const std::array<Vec3, 13> out = {
      Vec3(1, 0, 0),  Vec3(0, 1, 0),   Vec3(0, 0, 1), Vec3(1, 1, 1),  Vec3(1, 1, -1),
      Vec3(1, -1, 1), Vec3(1, -1, -1), Vec3(1, 1, 0), Vec3(1, -1, 0), Vec3(1, 0, 1),
      Vec3(1, 0, -1), Vec3(0, 1, 1),   Vec3(0, 1, -1)};
  return out;
}

class HullFit {
 public:
  HullFit(const FitInput& in, std::vector<uint32_t>& vertices)
      : in_(in), vertices_(vertices), seen_(in.mesh.vertices.size(), no_index) {}

  /// Sets radius and points of node i, which covers `range`.
  void node(uint32_t i, NodeRange range, HullVolume& out) {
    gather(i, range);
    out.first_point = uint32_t(vertices_.size());
    if (all_.size() <= keep_all) {
      vertices_.insert(vertices_.end(), all_.begin(), all_.end());
      out.radius = 0;
    } else {
      const std::vector<uint32_t> kept = outermost();
      vertices_.insert(vertices_.end(), kept.begin(), kept.end());
      out.radius = std::nextafter(float(distance_from(kept)), std::numeric_limits<float>::max());
    }
    out.point_count = uint32_t(vertices_.size()) - out.first_point;
  }

 private:
  /// Collects the distinct vertices of the node's triangles, in order of first occurrence.
  void gather(uint32_t i, NodeRange range) {
    all_.clear();
    for (uint32_t k = range.first; k < range.last; ++k) {
      for (uint32_t v : in_.mesh.triangles[in_.order[k]]) {
        if (seen_[v] == i) continue;
        seen_[v] = i;
        all_.push_back(v);
      }
    }
  }

  std::vector<uint32_t> outermost() const {
    std::vector<uint32_t> kept;
    for (const Vec3& d : hull_directions()) {
      uint32_t low = all_[0], high = all_[0];
      double least = d.dot(in_.mesh.vertices[low]), most = least;
      for (uint32_t v : all_) {
        const double h = d.dot(in_.mesh.vertices[v]);
        if (h < least) {
          least = h;
          low = v;
        }
        if (h > most) {
          most = h;
          high = v;
        }
      }
      kept.push_back(low);
      kept.push_back(high);
    }
    std::sort(kept.begin(), kept.end());
    kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
    return kept;
  }

  /// Bound of the distance of the farthest vertex from the hull of the kept ones.
  double distance_from(const std::vector<uint32_t>& kept) const {
    std::vector<Vec3> hull;
    for (uint32_t v : kept) hull.push_back(in_.mesh.vertices[v]);
    double radius = 0;
    for (uint32_t v : all_) {
      const Vec3& p = in_.mesh.vertices[v];
      // If the search stopped early, its upper bound is loose, and only useful if it is within the
      // radius.
      if (!(hull_distance({&p, 1}, hull, radius).upper <= radius))
        radius = std::max(radius, hull_distance({&p, 1}, hull).upper);
    }
    return radius;
  }

  const FitInput& in_;
  std::vector<uint32_t>& vertices_;
  std::vector<uint32_t> seen_;  // the last node that collected each vertex
  std::vector<uint32_t> all_;
};

}  // namespace

void HullKind::fit(const FitInput& in, std::vector<TreeNode<HullVolume>>& nodes) {
  std::vector<TreeNode<AabbVolume>> boxes(nodes.size());
  for (size_t i = 0; i < nodes.size(); ++i) {
    boxes[i].start = nodes[i].start;
    boxes[i].count = nodes[i].count;
  }
  AabbKind().fit(in, boxes);
  vertices_.clear();
  HullFit hulls(in, vertices_);
  const auto store = [&](uint32_t i, NodeRange range) {
    static_cast<AabbVolume&>(nodes[i]) = boxes[i];
    hulls.node(i, range, nodes[i]);
  };
  fit_upwards(nodes, store, store);
  vertices_.shrink_to_fit();
}

}  // namespace tumble
