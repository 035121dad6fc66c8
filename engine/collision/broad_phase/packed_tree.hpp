#pragma once
#include "engine/collision/broad_phase/pair_collector.hpp"

namespace tumble {

/// A binary tree of boxes over packed bounds, built at once along a space-filling curve (Lauterbach
/// et al., "Fast BVH Construction on GPUs", 2009, §3: Morton codes of the centres, split where the
/// highest bit changes; where codes run out, a finer curve of the members there). Fast enough to be
/// built anew in every tick.
class PackedTree {
 public:
  struct Node {
    PackedBounds bounds;
    uint32_t first = 0, last = 0;  ///< members below
    uint32_t right = 0;            ///< the left child follows its parent; 0 in a leaf
  };

  /// Over proxies[ids[..]]; can_be_placed() must hold for each; `origin` near their middle. The
  /// tree is the same for any number of threads.
  void build(std::span<const BroadPhaseProxy> proxies, std::span<const uint32_t> ids,
             const Vec3& origin, Crew* crew = nullptr);
  void clear();
  /// Every pair of two members.
  void pairs_within(PairCollector& out, Crew* crew = nullptr) const;
  /// Every pair of a member of this and one of `other`, packed about the same origin.
  void pairs_with(const PackedTree& other, PairCollector& out, Crew* crew = nullptr) const;
  /// Every pair of a member and one that is no member.
  void pairs_with(const PackedBounds& bounds, uint32_t id, PairCollector& out) const;

  /// The boxes of all nodes, coloured by depth; `origin` as given to build().
  void draw(const Vec3& origin, DebugDraw& out) const;
  const PackedSet& members() const { return set_; }
  const std::vector<Node>& nodes() const { return nodes_; }
  /// Takes the member at `position` out: it overlaps nothing any more. Boxes above stay.
  void remove(size_t position);
  /// Gives the member at `position` another id.
  void rename(size_t position, uint32_t id) { set_.ids[position] = id; }

 private:
  struct Coded {
    uint32_t code, id;
  };
  /// A subtree as it is built, apart from those that other threads build.
  struct Growth {
    std::vector<Node> nodes;
    std::vector<Coded> scratch;
  };
  /// Orders members along the curve through their own bounds; false if all are at one place.
  bool sort_by_code(uint32_t first, uint32_t last, std::vector<Coded>& scratch);
  /// Where the members [first, last) part into two children.
  uint32_t split(uint32_t first, uint32_t last, std::vector<Coded>& scratch);
  uint32_t add_node(uint32_t first, uint32_t last, Growth& out);
  void build_in_parallel(Crew& crew);

  PackedSet set_;
  std::vector<Node> nodes_;
  std::span<const BroadPhaseProxy> proxies_;  ///< during build()
  Vec3 origin_ = Vec3::Zero();                ///< during build()
  std::vector<Coded> coded_;
  Growth whole_;                  ///< keeps its memory from one build() to the next
  std::vector<Growth> branches_;  ///< the same of the threads
};

}  // namespace tumble
