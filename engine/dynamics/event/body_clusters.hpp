#pragma once
#include "engine/core/disjoint_sets.hpp"
#include "engine/dynamics/event/tolerances.hpp"

namespace tumble {

/// Which bodies of a group move together for a while, by their places in it: those that are tied to
/// each other, and besides those that may meet.
class BodyClusters {
 public:
  /// All by themselves.
  void reset(size_t bodies);
  /// They cannot move without each other. Before the first meet().
  void tie(uint32_t a, uint32_t b);
  /// They may come to touch.
  void meet(uint32_t a, uint32_t b);
  /// The least place in the cluster.
  uint32_t first(uint32_t body) { return sets_.root(body); }
  /// How many bodies of a cluster, by its first one, are outside of its largest part that is tied
  /// together.
  size_t strangers_of(uint32_t first) const { return counts_[first].bodies - counts_[first].tied; }
  /// Whether they are more than `most`, and many beside that part: what is tied together goes the
  /// way of its own events anyway.
  bool crowded(uint32_t first, size_t most) const {
    const size_t strangers = strangers_of(first);
    return strangers > most && tolerances::tied_to_stranger * strangers > counts_[first].tied;
  }

 private:
  struct Count {
    size_t bodies = 1, tied = 1;  ///< all, and in the largest part that is tied together
  };
  DisjointSets sets_;
  std::vector<Count> counts_;  ///< by first body
};

}  // namespace tumble
