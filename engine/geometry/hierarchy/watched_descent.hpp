#pragma once
#include "engine/geometry/hierarchy/bounding_tree_pairs.hpp"

namespace tumble {

/// A test of two nodes on the way down two trees.
struct DescentTest {
  uint32_t a = 0, b = 0;      ///< nodes, in the order in which visit_nodes() shows them
  bool apart = false;         ///< what lies below the two was left out
  uint32_t leaf_tests = 0;    ///< pairs of triangles that were tested here: both are leaves
  uint32_t leaves_found = 0;  ///< of them, those that are near
};

/// The way of a descent, and what it came to.
struct WatchedDescent {
  std::vector<DescentTest> tests;
  std::vector<TriangleIds> found;  ///< ascending
  bool whole = true;               ///< false: there were more tests or finds than were asked for
};

/// BoundingTree::pairs() of two trees of a kind by the same traversal and the same tests, with the
/// way of the descent. It is broken off at so many tests of volumes, or pairs of triangles found.
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
        // Once broken off nothing goes further down: what waits is emptied without tests.
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
