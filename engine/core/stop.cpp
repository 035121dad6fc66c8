#include "engine/core/stop.hpp"

#include <algorithm>

namespace tumble {

bool StopFlag::come(int64_t state) const noexcept {
  while (state > 1 && !state_.compare_exchange_weak(state, state - 1, std::memory_order_relaxed)) {
  }
  return state == requested_now || state == 1;
}

int64_t StopFlag::looks_left() const noexcept {
  return std::max<int64_t>(0, state_.load(std::memory_order_relaxed) - 1);
}

Error stopped_error() {
  return {ErrorCode::cancelled, "cancelled", {}, {}};
}

}  // namespace tumble
