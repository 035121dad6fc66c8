#pragma once
#include "engine/core/error.hpp"

#include <atomic>
#include <cstdint>

namespace tumble {

/// A request to stop: made by any thread, or by a signal handler, and looked at by the work that it
/// is meant for. It stays until it is cleared.
class StopFlag {
 public:
  void request() noexcept { state_.store(requested_now, std::memory_order_relaxed); }
  /// As if the request came when so many more looks had been taken: for tests, which a clock would
  /// not stop at the same place twice.
  void request_after(int64_t looks) noexcept { state_.store(looks + 1, std::memory_order_relaxed); }
  void clear() noexcept { state_.store(quiet, std::memory_order_relaxed); }
  bool requested() const noexcept {
    const int64_t state = state_.load(std::memory_order_relaxed);
    return state != quiet && come(state);
  }
  /// After request_after(): looks that are left; below 0 how many have seen the request since.
  int64_t looks_left() const noexcept;

 private:
  static constexpr int64_t quiet = 0, requested_now = -1;
  bool come(int64_t state) const noexcept;

  /// quiet, requested_now, one more than the looks that are left, or, below requested_now, by how
  /// many looks a request that came was seen.
  mutable std::atomic<int64_t> state_{quiet};
  static_assert(std::atomic<int64_t>::is_always_lock_free);  // signal handlers may store
};

namespace detail {
/// The flag that the work of this thread looks at; null: nothing stops it.
inline thread_local constinit const StopFlag* present_stop = nullptr;
}  // namespace detail

/// While it lives, what this thread does is stopped by a flag, or, with null, by none; so is what
/// the threads of a Crew do for it. As a task group of oneTBB, work is stopped from the outside
/// without a word of it in any signature in between.
class Stoppable {
 public:
  explicit Stoppable(const StopFlag* flag) noexcept : before_(detail::present_stop) {
    detail::present_stop = flag;
  }
  ~Stoppable() { detail::present_stop = before_; }
  Stoppable(const Stoppable&) = delete;
  Stoppable& operator=(const Stoppable&) = delete;

  /// The flag of this thread's work now.
  static const StopFlag* present() noexcept { return detail::present_stop; }

 private:
  const StopFlag* before_;
};

/// Whether the work of this thread is to stop. A loop that may take longer than some milliseconds
/// asks once a round and ends anywhere; what it leaves is thrown away by whoever made the work
/// stoppable, who asks last of all. Costs two loads.
inline bool stop_requested() noexcept {
  const StopFlag* flag = detail::present_stop;
  return flag && flag->requested();
}

/// What functions that can say so return when they were stopped.
Error stopped_error();

}  // namespace tumble
