#pragma once
#include "engine/dynamics/rigid/proxies.hpp"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tumble {

/// Pairs of bodies that do not collide with each other, by slot.
class PairFilter {
 public:
  void clear() { pairs_.clear(); }
  void add(uint32_t a, uint32_t b);
  /// After the last add.
  void sort();
  bool empty() const { return pairs_.empty(); }
  bool excludes(uint32_t a, uint32_t b) const;
  /// Takes the excluded pairs out, keeping the order of the rest.
  void apply(const ProxySet& proxies, std::vector<ProxyPair>& pairs) const;

 private:
  std::vector<std::pair<uint32_t, uint32_t>> pairs_;  ///< sorted, lower slot first
};

}  // namespace tumble
