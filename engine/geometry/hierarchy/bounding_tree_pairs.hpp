#pragma once
#include "engine/geometry/hierarchy/bounding_tree.hpp"
#include "engine/geometry/hierarchy/common_vertices.hpp"

#include <algorithm>

// Simultaneous traversal of two trees, or of one with itself: a kind defines the test of two
// volumes (PairTest), and a query what to do for two leaves.
namespace tumble {

/// Visits every pair of leaves whose volumes `apart(a, b)` does not separate. `a` is the same tree
/// as `b` when `self`; then each unordered pair is visited once, a leaf with itself included, but
/// not what lies below two nodes (maybe the same) with `skipped(i, j)`. Stops when `leaves(a, b)`
/// returns false.
template <bool self, class Tree, class Apart, class Leaves, class Skipped>
void traverse(const Tree& ta, const Tree& tb, const Apart& apart, const Leaves& leaves,
              const Skipped& skipped) {
  const auto &na = ta.nodes(), &nb = tb.nodes();
  if (na.empty() || nb.empty()) return;
  std::vector<TriangleIds> stack{{0, 0}};
  while (!stack.empty()) {
    const auto [i, j] = stack.back();
    stack.pop_back();
    const auto &a = na[i], &b = nb[j];
    if (self && skipped(i, j)) continue;
    if (self && i == j) {
      if (a.is_leaf()) {
        if (!leaves(a, b)) return;
        continue;
      }
      stack.push_back({i + 1, a.start});
      stack.push_back({a.start, a.start});
      stack.push_back({i + 1, i + 1});
      continue;
    }
    if (apart(a, b)) continue;
    if (a.is_leaf() && b.is_leaf()) {
      if (!leaves(a, b)) return;
    } else if (b.is_leaf() || (!a.is_leaf() && Tree::size_of(a) >= Tree::size_of(b))) {
      stack.push_back({a.start, j});
      stack.push_back({i + 1, j});
    } else {
      stack.push_back({i, b.start});
      stack.push_back({i, j + 1});
    }
  }
}

template <bool self, class Tree, class Apart, class Leaves>
void traverse(const Tree& ta, const Tree& tb, const Apart& apart, const Leaves& leaves) {
  traverse<self>(ta, tb, apart, leaves, [](uint32_t, uint32_t) { return false; });
}

/// The triangles of two leaves in the first mesh's frame; those of B are kept for the next pair.
template <class Tree>
class LeafPair {
 public:
  LeafPair(const Tree& a, const Tree& b, const RelativePose& b_in_a) : a_(a), b_(b), at_(b_in_a) {}

  /// Calls visit(ids, corners of a, corners of b) until it returns false; then returns false.
  template <class Visit>
  bool each(const typename Tree::Node& na, const typename Tree::Node& nb, const Visit& visit) {
    if (held_ != &nb) {
      held_ = &nb;
      for (uint32_t j = 0; j < nb.count; ++j) {
        other_[j] = corners(b_.mesh(), b_.triangle_order()[nb.start + j], at_);
      }
    }
    for (uint32_t i = 0; i < na.count; ++i) {
      const uint32_t a = a_.triangle_order()[na.start + i];
      const TriangleCorners own = corners(a_.mesh(), a);
      for (uint32_t j = 0; j < nb.count; ++j) {
        if (!visit(TriangleIds{a, b_.triangle_order()[nb.start + j]}, own, other_[j])) return false;
      }
    }
    return true;
  }

 private:
  const Tree &a_, &b_;
  RelativePose at_;
  const void* held_ = nullptr;
  std::array<TriangleCorners, TreeLayout::max_leaf_triangles> other_;
};

/// Adds the cost of a query to the statistics.
class PairCost {
 public:
  explicit PairCost(HierarchyStatistics* out) : out_(out) {}
  ~PairCost() {
    if (!out_) return;
    out_->node_tests += work.node_tests;
    out_->triangle_tests += work.triangle_tests;
  }
  PairCost(const PairCost&) = delete;
  PairCost& operator=(const PairCost&) = delete;
  HierarchyStatistics work;

 private:
  HierarchyStatistics* out_;
};

/// Calls query(a, b) with trees of one kind; another kind beside this one gets a tree of this kind
/// for the query.
template <class Kind, class Query>
auto with_same_kind(const BoundingTree<Kind>&, const Hierarchy& other, const Query& query) {
  if (const auto* tree = dynamic_cast<const BoundingTree<Kind>*>(&other)) return query(*tree);
  const BoundingTree<Kind> made(other.shared_mesh());
  return query(made);
}

template <class Kind>
void BoundingTree<Kind>::pairs(const Hierarchy& other, const Pose& other_pose, double margin,
                               std::vector<TriangleIds>& out, HierarchyStatistics* cost) const {
  with_same_kind(*this, other, [&](const BoundingTree& b) {
    const size_t before = out.size();
    const RelativePose at(other_pose);
    const typename Kind::template PairTest<false> test(*this, b, at, margin, Vec3::Zero());
    PairCost counted(cost);
    LeafPair<BoundingTree> leaf(*this, b, at);
    traverse<false>(
        *this, b,
        [&](const Node& na, const Node& nb) {
          ++counted.work.node_tests;
          return test.apart(na, nb);
        },
        [&](const Node& na, const Node& nb) {
          counted.work.triangle_tests += size_t(na.count) * nb.count;
          return leaf.each(
              na, nb, [&](TriangleIds ids, const TriangleCorners& ta, const TriangleCorners& tb) {
                if (triangles_near(ta, tb, margin)) out.push_back(ids);
                return true;
              });
        });
    std::sort(out.begin() + std::ptrdiff_t(before), out.end());
  });
}

template <class Kind>
bool BoundingTree<Kind>::intersects(const Hierarchy& other, const Pose& other_pose,
                                    HierarchyStatistics* cost) const {
  return with_same_kind(*this, other, [&](const BoundingTree& b) {
    const RelativePose at(other_pose);
    const typename Kind::template PairTest<false> test(*this, b, at, 0, Vec3::Zero());
    PairCost counted(cost);
    LeafPair<BoundingTree> leaf(*this, b, at);
    bool found = false;
    traverse<false>(
        *this, b,
        [&](const Node& na, const Node& nb) {
          ++counted.work.node_tests;
          return test.apart(na, nb);
        },
        [&](const Node& na, const Node& nb) {
          return leaf.each(na, nb,
                           [&](TriangleIds, const TriangleCorners& ta, const TriangleCorners& tb) {
                             ++counted.work.triangle_tests;
                             found = triangles_meet(ta, tb);
                             return !found;
                           });
        });
    return found;
  });
}

template <class Kind>
void BoundingTree<Kind>::self_pairs(double margin, std::vector<TriangleIds>& out,
                                    HierarchyStatistics* cost) const {
  const size_t before = out.size();
  const RelativePose here;
  const typename Kind::template PairTest<false> test(*this, *this, here, margin, Vec3::Zero());
  const CommonVertices common(nodes_, *mesh_, order_);
  PairCost counted(cost);
  LeafPair<BoundingTree> leaf(*this, *this, here);
  traverse<true>(
      *this, *this,
      [&](const Node& na, const Node& nb) {
        ++counted.work.node_tests;
        return test.apart(na, nb);
      },
      [&](const Node& na, const Node& nb) {
        return leaf.each(
            na, nb, [&](TriangleIds ids, const TriangleCorners& ta, const TriangleCorners& tb) {
              if ((&na == &nb && ids.a >= ids.b) || neighbours(*mesh_, ids.a, ids.b)) return true;
              ++counted.work.triangle_tests;
              // The same order of arguments whichever leaf was first.
              const bool near =
                  ids.a < ids.b ? triangles_near(ta, tb, margin) : triangles_near(tb, ta, margin);
              if (near) out.push_back({std::min(ids.a, ids.b), std::max(ids.a, ids.b)});
              return true;
            });
      },
      [&](uint32_t i, uint32_t j) { return common.neighbours(i, j); });
  std::sort(out.begin() + std::ptrdiff_t(before), out.end());
}

template <class Kind>
void BoundingTree<Kind>::swept_pairs(const Hierarchy& other, const SweptQuery& query,
                                     std::vector<TriangleIds>& out,
                                     HierarchyStatistics* cost) const {
  with_same_kind(*this, other, [&](const BoundingTree& b) {
    const size_t before = out.size();
    const RelativePose at(query.other_pose);
    const Vec3 sweep = query.other_motion.translation - query.own.translation;
    const typename Kind::template PairTest<true> test(*this, b, at, query.margin, sweep);
    // Centres of rotation about the trees' origins, each in its own frame.
    const Vec3 centre_a = query.own.centre - origin_;
    const Vec3 centre_b = query.other_pose.inverse_point(query.other_motion.centre) - b.origin_;
    const double chord_a = query.own.chord(), chord_b = query.other_motion.chord();
    PairCost counted(cost);
    LeafPair<BoundingTree> leaf(*this, b, at);
    traverse<false>(
        *this, b,
        [&](const Node& na, const Node& nb) {
          ++counted.work.node_tests;
          const double turned =
              chord_a * Kind::furthest(na, centre_a) + chord_b * Kind::furthest(nb, centre_b);
          return test.apart(na, nb, 1.00001 * turned);
        },
        [&](const Node& na, const Node& nb) {
          return leaf.each(
              na, nb, [&](TriangleIds ids, const TriangleCorners& ta, const TriangleCorners& tb) {
                ++counted.work.triangle_tests;
                const double reach = query.margin + turned_reach(ta, query.own) +
                                     turned_reach(tb, query.other_motion);
                if (swept_triangles_near(ta, tb, sweep, reach)) out.push_back(ids);
                return true;
              });
        });
    std::sort(out.begin() + std::ptrdiff_t(before), out.end());
  });
}

}  // namespace tumble
