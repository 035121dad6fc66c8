#pragma once
#include "engine/collision/broad_phase/pair_collector.hpp"

namespace tumble {

/// A binary tree of boxes over packed bounds, built along a space-filling curve (Lauterbach et al.,
/// "Fast BVH Construction on GPUs", 2009, §3: Morton codes of the centres, split where the highest
/// bit changes; members with equal codes get a finer curve of their own). Fast enough to be rebuilt
/// in every tick.
class PackedTree {
 public:
  struct Node {
    PackedBounds bounds;
    uint32_t first = 0, last = 0;  ///< members below
    uint32_t right = 0;            ///< the left child follows its parent; 0 in a leaf
  };

  /// Builds the tree over proxies[ids[..]]. can_be_placed() must hold for each; `origin` should be
  /// near their middle. The tree is the same for any number of threads.
  void build(std::span<const BroadPhaseProxy> proxies, std::span<const uint32_t> ids,
             const Vec3& origin, Crew* crew = nullptr);
  void clear();
  /// Every pair of two members.
  void pairs_within(PairCollector& out, Crew* crew = nullptr) const;
  /// Every pair of a member of this and one of `other`, which must be packed about the same origin.
  void pairs_with(const PackedTree& other, PairCollector& out, Crew* crew = nullptr) const;
  /// Every pair of a member with bounds that are not a member.
  void pairs_with(const PackedBounds& bounds, uint32_t id, PairCollector& out) const;

  /// The boxes of all nodes, coloured by depth; `origin` as given to build().
  void draw(const Vec3& origin, DebugDraw& out) const;
  const PackedSet& members() const { return set_; }
  const std::vector<Node>& nodes() const { return nodes_; }
  /// Removes the member at `position`, which then overlaps nothing. Boxes above it are unchanged.
  void remove(size_t position);
  /// Gives the member at `position` another id.
  void rename(size_t position, uint32_t id) { set_.ids[position] = id; }

 private:
  struct Coded {
    uint32_t code, id;
  };
  /// A subtree while it is built, possibly on a thread of its own.
  struct Growth {
    std::vector<Node> nodes;
    std::vector<Coded> scratch;
  };
  /// Sorts members along the curve through their own bounds; false if all are at the same place.
  bool sort_by_code(uint32_t first, uint32_t last, std::vector<Coded>& scratch);
  /// The index that divides the members [first, last) between two children.
  uint32_t split(uint32_t first, uint32_t last, std::vector<Coded>& scratch);
  uint32_t add_node(uint32_t first, uint32_t last, Growth& out);
  void build_in_parallel(Crew& crew);

  PackedSet set_;
  std::vector<Node> nodes_;
  std::span<const BroadPhaseProxy> proxies_;  ///< during build()
  Vec3 origin_ = Vec3::Zero();                ///< during build()
  std::vector<Coded> coded_;
  Growth whole_;                  ///< memory for build(), reused
  std::vector<Growth> branches_;  ///< likewise, by thread
};

}  // namespace tumble
