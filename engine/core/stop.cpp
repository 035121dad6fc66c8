#include "engine/core/stop.hpp"

#include <algorithm>

namespace tumble {

bool StopFlag::come(int64_t state) const noexcept {
  if (state == requested_now) return true;
  const auto next = [](int64_t now) { return now == 1 ? requested_now - 1 : now - 1; };
  while (!state_.compare_exchange_weak(state, next(state), std::memory_order_relaxed))
    if (state == quiet || state == requested_now) break;  // set meanwhile
  return state == 1 || state < 0;
}

int64_t StopFlag::looks_left() const noexcept {
  const int64_t state = state_.load(std::memory_order_relaxed);
  return state > 0 ? state - 1 : std::min<int64_t>(0, state - requested_now);
}

Error stopped_error() {
  return {ErrorCode::cancelled, "cancelled", {}, {}};
}

}  // namespace tumble
