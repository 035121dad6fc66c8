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
  /// Excludes none.
  void clear() {
    pairs_.clear();
    groups_.clear();
  }
  /// From now on bodies of one group do not collide either, by what they are now.
  void set_groups(std::span<const RigidBody> bodies);
  void add(uint32_t a, uint32_t b);
  /// After the last add.
  void sort();
  bool excludes(uint32_t a, uint32_t b) const;
  /// Takes the excluded pairs out, keeping the order of the rest.
  void apply(const ProxySet& proxies, std::vector<ProxyPair>& pairs) const;

 private:
  bool of_one_group(uint32_t a, uint32_t b) const {
    return a < groups_.size() && b < groups_.size() && groups_[a] != 0 && groups_[a] == groups_[b];
  }

  std::vector<std::pair<uint32_t, uint32_t>> pairs_;  ///< sorted, lower slot first
  std::vector<uint32_t> groups_;                      ///< by slot; empty if nobody has one
};

}  // namespace tumble
