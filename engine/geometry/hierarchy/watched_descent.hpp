#pragma once
#include "engine/geometry/hierarchy/bounding_tree_pairs.hpp"

namespace tumble {

/// A test of two nodes during the simultaneous descent of two trees.
struct DescentTest {
  uint32_t a = 0, b = 0;      ///< nodes, in the order of visit_nodes()
  bool apart = false;         ///< the pair was pruned
  uint32_t leaf_tests = 0;    ///< pairs of triangles that were tested, if both are leaves
  uint32_t leaves_found = 0;  ///< of them, those that are near
};

/// The tests of a descent, and its result.
struct WatchedDescent {
  std::vector<DescentTest> tests;
  std::vector<TriangleIds> found;  ///< ascending
  bool whole = true;               ///< false: stopped at the limit of tests or of pairs found
};

/// BoundingTree::pairs() of two trees of a kind by the same traversal and the same tests, with a
/// record of the tests. It stops at a limit of tests of volumes, or of pairs of triangles found.
template <class Kind>
WatchedDescent watch_pairs(const BoundingTree<Kind>& a, const BoundingTree<Kind>& b,
                           const Pose& b_in_a, double margin, size_t most) {
  using Tree = BoundingTree<Kind>;
  using Node = typename Tree::Node;
  const RelativePose at(b_in_a);
  const typename Kind::template PairTest<false> test(a, b, at, margin, Vec3::Zero());
  LeafPair<Tree> leaf(a, b, at);
  WatchedDescent out;
  traverse<false>(
      a, b,
      [&](const Node& na, const Node& nb) {
        // After the stop nothing is descended into: the waiting pairs are removed without tests.
        if (out.tests.size() >= most) out.whole = false;
        if (!out.whole) return true;
        const bool apart = test.apart(na, nb);
        out.tests.push_back(
            {uint32_t(&na - a.nodes().data()), uint32_t(&nb - b.nodes().data()), apart});
        return apart;
      },
      [&](const Node& na, const Node& nb) {
        const size_t known = out.found.size();
        leaf.each(na, nb,
                  [&](TriangleIds ids, const TriangleCorners& ta, const TriangleCorners& tb) {
                    if (triangles_near(ta, tb, margin)) out.found.push_back(ids);
                    return true;
                  });
        out.tests.back().leaf_tests = na.count * nb.count;
        out.tests.back().leaves_found = uint32_t(out.found.size() - known);
        if (out.found.size() > most) out.whole = false;
        return out.whole;
      });
  std::sort(out.found.begin(), out.found.end());
  return out;
}

}  // namespace tumble
