#include "engine/geometry/hierarchy/aabb_tree.hpp"

#include <algorithm>
#include <cmath>

// Two trees at once: node boxes of the other tree are oriented boxes in this tree's frame. The node
// test uses the six face axes of Gottschalk et al. 1996 only; missing the nine edge axes costs some
// visits and no answers.
namespace tumble {
namespace {

struct NodePair {
  uint32_t a, b;
};

/// Box in its own axes about a centre.
struct HalfBox {
  Vec3 centre, half;
};

HalfBox half_box(const AabbTree::Node& n) {
  HalfBox out;
  for (int k = 0; k < 3; ++k) {
    const double low = double(n.min[size_t(k)]), high = double(n.max[size_t(k)]);
    out.centre[k] = 0.5 * (low + high);
    out.half[k] = 0.5 * (high - low);
  }
  return out;
}

/// Where frame B (its tree's origin) lies in frame A (likewise).
struct Relative {
  Mat3 rotation, absolute;  // absolute: |entries|, slightly enlarged for rounding
  Vec3 offset;
  double margin;

  bool apart(const HalfBox& a, const HalfBox& b) const {
    const Vec3 d = rotation * b.centre + offset - a.centre;
    const Vec3 reach = absolute * b.half;
    for (int k = 0; k < 3; ++k) {
      if (std::fabs(d[k]) > a.half[k] + reach[k] + margin) return true;
    }
    const Vec3 d_b = rotation.transpose() * d;
    const Vec3 reach_a = absolute.transpose() * a.half;
    for (int k = 0; k < 3; ++k) {
      if (std::fabs(d_b[k]) > b.half[k] + reach_a[k] + margin) return true;
    }
    return false;
  }
};

double volume_measure(const HalfBox& b) {
  return b.half.x() + b.half.y() + b.half.z();
}

void pairs_with_any(const AabbTree& tree, const Hierarchy& other, const Pose& pose, double margin,
                    std::vector<TriangleIds>& out) {
  std::vector<uint32_t> found;
  for (uint32_t b = 0; b < other.mesh().triangles.size(); ++b) {
    Aabb box;
    for (size_t k = 0; k < 3; ++k) box.include(pose.point(other.mesh().corner(b, k)));
    found.clear();
    // A little more than the margin: the shared test below decides.
    tree.overlap(box.inflated(margin * (1 + 1e-12) + 1e-14 * (box.min.norm() + box.max.norm())),
                 found);
    for (uint32_t a : found) {
      if (triangle_boxes_near(tree.mesh(), a, other.mesh(), b, pose, margin)) {
        out.push_back({a, b});
      }
    }
  }
}

/// The boxes of a leaf's triangles, in their own frame and in the other.
struct LeafBoxes {
  std::array<Aabb, AabbTree::max_leaf_triangles> own, other;
};

template <class Map>
LeafBoxes leaf_boxes(const AabbTree& tree, const AabbTree::Node& leaf, double margin,
                     const Map& to_other) {
  LeafBoxes out;
  for (uint32_t i = 0; i < leaf.count; ++i) {
    const uint32_t t = tree.triangle_order()[leaf.start + i];
    out.own[i] = triangle_bounds(tree.mesh(), t).inflated(margin);
    for (size_t k = 0; k < 3; ++k) out.other[i].include(to_other(tree.mesh().corner(t, k)));
  }
  return out;
}

/// The decision of triangle_boxes_near for all pairs of two leaves.
void leaf_pairs(const AabbTree& ta, const AabbTree& tb, const AabbTree::Node& na,
                const AabbTree::Node& nb, const Pose& pose, double margin,
                std::vector<TriangleIds>& out) {
  const LeafBoxes a =
      leaf_boxes(ta, na, margin, [&](const Vec3& p) { return pose.inverse_point(p); });
  const LeafBoxes b = leaf_boxes(tb, nb, margin, [&](const Vec3& p) { return pose.point(p); });
  for (uint32_t i = 0; i < na.count; ++i) {
    for (uint32_t j = 0; j < nb.count; ++j) {
      if (a.own[i].overlaps(b.other[j]) && b.own[j].overlaps(a.other[i])) {
        out.push_back({ta.triangle_order()[na.start + i], tb.triangle_order()[nb.start + j]});
      }
    }
  }
}

}  // namespace

void AabbTree::pairs(const Hierarchy& other, const Pose& other_pose, double margin,
                     std::vector<TriangleIds>& out, HierarchyStatistics* cost) const {
  const size_t before = out.size();
  const auto* tree = dynamic_cast<const AabbTree*>(&other);
  if (!tree) {
    pairs_with_any(*this, other, other_pose, margin, out);
    std::sort(out.begin() + std::ptrdiff_t(before), out.end());
    return;
  }
  if (nodes_.empty() || tree->nodes_.empty()) return;

  Relative relative;
  relative.rotation = other_pose.q.toRotationMatrix();
  relative.absolute = relative.rotation.cwiseAbs().array() + 1e-14;
  relative.offset = other_pose.point(tree->origin_) - origin_;
  relative.margin = margin * (1 + 1e-12) + slack_ + tree->slack_ +
                    1e-13 * (relative.offset.norm() + other_pose.x.norm() +
                             bounds_.extent().norm() + tree->bounds_.extent().norm());

  std::vector<NodePair> stack{{0, 0}};
  HierarchyStatistics work;
  while (!stack.empty()) {
    const NodePair pair = stack.back();
    stack.pop_back();
    const Node& na = nodes_[pair.a];
    const Node& nb = tree->nodes_[pair.b];
    const HalfBox a = half_box(na), b = half_box(nb);
    ++work.node_tests;
    if (relative.apart(a, b)) continue;
    if (na.is_leaf() && nb.is_leaf()) {
      work.triangle_tests += size_t(na.count) * nb.count;
      leaf_pairs(*this, *tree, na, nb, other_pose, margin, out);
    } else if (nb.is_leaf() || (!na.is_leaf() && volume_measure(a) >= volume_measure(b))) {
      stack.push_back({na.start, pair.b});
      stack.push_back({pair.a + 1, pair.b});
    } else {
      stack.push_back({pair.a, nb.start});
      stack.push_back({pair.a, pair.b + 1});
    }
  }
  std::sort(out.begin() + std::ptrdiff_t(before), out.end());
  if (cost) {
    cost->node_tests += work.node_tests;
    cost->triangle_tests += work.triangle_tests;
  }
}

}  // namespace tumble
