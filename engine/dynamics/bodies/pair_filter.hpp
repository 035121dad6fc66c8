#pragma once
#include "engine/dynamics/bodies/proxies.hpp"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tumble {

/// Pairs of bodies that do not collide with each other, by slot.
class PairFilter {
 public:
  /// Excludes no pairs.
  void clear() {
    pairs_.clear();
    groups_.clear();
  }
  /// Excludes pairs of bodies of one group, by the groups that the bodies have now.
  void set_groups(std::span<const RigidBody> bodies);
  void add(uint32_t a, uint32_t b);
  /// To be called after the last add().
  void sort();
  bool excludes(uint32_t a, uint32_t b) const;
  /// Removes the excluded pairs; the others keep their order.
  void apply(const ProxySet& proxies, std::vector<ProxyPair>& pairs) const;

 private:
  bool of_one_group(uint32_t a, uint32_t b) const {
    return a < groups_.size() && b < groups_.size() && groups_[a] != 0 && groups_[a] == groups_[b];
  }

  std::vector<std::pair<uint32_t, uint32_t>> pairs_;  ///< sorted, lower slot first
  std::vector<uint32_t> groups_;                      ///< by slot; empty if no body has a group
};

}  // namespace tumble
