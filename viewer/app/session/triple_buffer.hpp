#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <utility>

namespace tumble {

/// Passes the newest value from one writing thread to one reading thread without waiting on either
/// side. Values that are not read in time are overwritten.
template <class T>
class TripleBuffer {
 public:
  /// Writer thread only.
  void publish(T value) {
    slots_[write_] = std::move(value);
    write_ = shared_.exchange(uint8_t(write_ | fresh), std::memory_order_acq_rel) & index_mask;
  }
  /// Reader thread only: the newest published value, valid until the next call.
  const T& latest() {
    if (shared_.load(std::memory_order_relaxed) & fresh)
      read_ = shared_.exchange(read_, std::memory_order_acq_rel) & index_mask;
    return slots_[read_];
  }

 private:
  static constexpr uint8_t fresh = 4, index_mask = 3;
  std::array<T, 3> slots_{};
  uint8_t write_ = 0;               ///< slot of the writer
  std::atomic<uint8_t> shared_{1};  ///< slot in between, with a flag for a new value
  uint8_t read_ = 2;                ///< slot of the reader
};

}  // namespace tumble
