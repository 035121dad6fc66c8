#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace tumble {

/// Union-find over the numbers below n. The representative of a set is its least member, whatever
/// the order of the unions.
class DisjointSets {
 public:
  explicit DisjointSets(size_t n = 0) { reset(n); }
  void reset(size_t n) {
    parent_.resize(n);
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  /// The same, if only these numbers will be used.
  void reset(size_t n, std::span<const uint32_t> used) {
    parent_.resize(n);
    for (const uint32_t i : used) parent_[i] = i;
  }
  uint32_t root(uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(uint32_t a, uint32_t b) {
    a = root(a), b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }
  size_t bytes() const { return parent_.capacity() * sizeof(uint32_t); }

 private:
  std::vector<uint32_t> parent_;
};

}  // namespace tumble
