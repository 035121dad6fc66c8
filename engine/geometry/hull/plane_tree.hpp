#pragma once
#include "engine/geometry/constructions/projections.hpp"
#include "engine/geometry/triangle_mesh.hpp"

#include <span>

namespace tumble {

/// Finds planes that have a point on their outer side, without trying every plane: a binary tree
/// whose nodes bound the normals of their planes by a cone. The planes must outlive the tree.
class PlaneTree {
 public:
  /// `touched`: for each plane a point near it, best one where it touches what it bounds.
  PlaneTree(std::span<const Plane> planes, std::vector<Vec3> touched);

  /// The first plane (lowest number) that `p` is more than `epsilon` [m] outside of, or no_index.
  uint32_t first_outside(const Vec3& p, double epsilon) const;

 private:
  struct Node {
    Vec3 axis;            // of the cone, unit
    double sine, cosine;  // of its half angle: upper and lower bound
    Vec3 anchor;          // one of the points that the planes touch
    double offset;        // the least height of a plane over the anchor [m]
    uint32_t begin, end;  // planes order_[begin] .. order_[end - 1]
    uint32_t right;       // second child; the first follows the node; 0 for a leaf
  };
  void build(uint32_t begin, uint32_t end);

  std::span<const Plane> planes_;
  std::vector<Vec3> touched_;
  double slack_ = 0;
  std::vector<uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace tumble
