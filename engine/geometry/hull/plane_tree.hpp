#pragma once
#include "engine/geometry/constructions/projections.hpp"
#include "engine/geometry/triangle_mesh.hpp"

#include <span>

namespace tumble {

/// Finds planes that have a point on their outer side, without trying every plane: a binary tree
/// whose nodes bound the normals of their planes by a cone. The planes must outlive the tree.
class PlaneTree {
 public:
  /// `centre`: any point, best one that most planes have inside.
  PlaneTree(std::span<const Plane> planes, const Vec3& centre);

  /// The first plane (lowest number) that `p` is more than `epsilon` [m] outside of, or no_index.
  uint32_t first_outside(const Vec3& p, double epsilon) const;

 private:
  struct Node {
    Vec3 axis;            // of the cone, unit
    double sine, cosine;  // of its half angle: upper and lower bound
    double offset;        // the least distance of a plane from the centre [m]
    uint32_t begin, end;  // planes order_[begin] .. order_[end - 1]
    uint32_t right;       // second child; the first follows the node; 0 for a leaf
  };
  void build(uint32_t begin, uint32_t end);

  std::span<const Plane> planes_;
  Vec3 centre_;
  double slack_ = 0;
  std::vector<uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace tumble
