#pragma once
#include "engine/core/memory_use.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace tumble {

/// The bodies for which values that were derived from them are out of date.
class StaleBodies {
 public:
  /// All bodies are.
  void note_all() { all_ = true; }
  void note(size_t bodies, std::span<const uint32_t> slots) {
    if (all_) return;
    listed_.resize(bodies, 0);
    for (const uint32_t i : slots)
      if (!std::exchange(listed_[i], uint8_t{1})) slots_.push_back(i);
  }
  bool all() const { return all_; }
  /// Their slots, ascending.
  std::span<const uint32_t> slots(size_t bodies) {
    if (all_) {
      slots_.resize(bodies);
      std::iota(slots_.begin(), slots_.end(), 0u);
    } else {
      std::ranges::sort(slots_);
    }
    return slots_;
  }
  /// None is any more.
  void clear() {
    for (const uint32_t i : slots_)
      if (i < listed_.size()) listed_[i] = 0;
    slots_.clear();
    all_ = false;
  }
  size_t bytes() const { return heap_bytes(slots_, listed_); }

 private:
  bool all_ = true;
  std::vector<uint32_t> slots_;
  std::vector<uint8_t> listed_;  ///< by slot
};

}  // namespace tumble
