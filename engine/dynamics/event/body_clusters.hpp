#pragma once
#include "engine/core/disjoint_sets.hpp"
#include "engine/dynamics/event/tolerances.hpp"

namespace tumble {

/// Which bodies of a group move together for a while, by their places in the group: those that are
/// tied to each other, and besides those that may meet.
class BodyClusters {
 public:
  /// Starts with every body in a cluster of its own.
  void reset(size_t bodies);
  /// Joins two bodies that are tied together (by joints, springs, closed contacts). All calls
  /// before the first meet().
  void tie(uint32_t a, uint32_t b);
  /// Joins the clusters of two bodies that may come to touch.
  void meet(uint32_t a, uint32_t b);
  /// The lowest place in the cluster of a body; it names the cluster.
  uint32_t first(uint32_t body) { return sets_.root(body); }
  /// How many bodies of a cluster, named by its first one, do not belong to its largest tied part.
  size_t strangers_of(uint32_t first) const { return counts_[first].bodies - counts_[first].tied; }
  /// Whether these are more than `most`, and many compared with that part. A tied part must take
  /// the steps of all its events anyway, so that a few untied bodies beside it cost little.
  bool crowded(uint32_t first, size_t most) const {
    const size_t strangers = strangers_of(first);
    return strangers > most && tolerances::tied_to_stranger * strangers > counts_[first].tied;
  }

 private:
  struct Count {
    size_t bodies = 1, tied = 1;  ///< of all, and of the largest part that is tied together
  };
  DisjointSets sets_;
  std::vector<Count> counts_;  ///< by first body of the cluster
};

}  // namespace tumble
