#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <utility>

namespace tumble {

/// Hands the newest value from one writing thread to one reading thread; neither ever waits.
/// Values that the reader did not fetch in time are overwritten.
template <class T>
class TripleBuffer {
 public:
  /// Writer only.
  void publish(T value) {
    slots_[write_] = std::move(value);
    write_ = shared_.exchange(uint8_t(write_ | fresh), std::memory_order_acq_rel) & index_mask;
  }
  /// Reader only: the newest published value; valid until the next call.
  const T& latest() {
    if (shared_.load(std::memory_order_relaxed) & fresh)
      read_ = shared_.exchange(read_, std::memory_order_acq_rel) & index_mask;
    return slots_[read_];
  }

 private:
  static constexpr uint8_t fresh = 4, index_mask = 3;
  std::array<T, 3> slots_{};
  uint8_t write_ = 0;               ///< writer's own slot
  std::atomic<uint8_t> shared_{1};  ///< the slot between them, with the fresh bit
  uint8_t read_ = 2;                ///< reader's own slot
};

}  // namespace tumble
