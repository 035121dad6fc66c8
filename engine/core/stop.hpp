#pragma once
#include "engine/core/error.hpp"

#include <atomic>
#include <cstdint>

namespace tumble {

/// A request to stop, made by any thread or by a signal handler, and polled by the work that it is
/// meant for. It remains until it is cleared.
class StopFlag {
 public:
  void request() noexcept { state_.store(requested_now, std::memory_order_relaxed); }
  /// Makes the request take effect after so many polls: for tests, which need the same place every
  /// time.
  void request_after(int64_t looks) noexcept { state_.store(looks + 1, std::memory_order_relaxed); }
  void clear() noexcept { state_.store(quiet, std::memory_order_relaxed); }
  bool requested() const noexcept {
    const int64_t state = state_.load(std::memory_order_relaxed);
    return state != quiet && come(state);
  }
  /// After request_after(): polls that remain; if negative, the number of polls since the request.
  int64_t looks_left() const noexcept;

 private:
  static constexpr int64_t quiet = 0, requested_now = -1;
  bool come(int64_t state) const noexcept;

  /// quiet; requested_now; 1 + the polls that remain; or less than requested_now, by the number of
  /// polls since a delayed request.
  mutable std::atomic<int64_t> state_{quiet};
  static_assert(std::atomic<int64_t>::is_always_lock_free);  // signal handlers may store
};

namespace detail {
/// The flag that work on this thread polls; null: it cannot be stopped.
inline thread_local constinit const StopFlag* present_stop = nullptr;
}  // namespace detail

/// During its life, work on this thread, and what the threads of a Crew do for it, is stopped by
/// this flag, or with null by none. Like a task group of oneTBB, this stops work from outside
/// without a parameter in the functions in between.
class Stoppable {
 public:
  explicit Stoppable(const StopFlag* flag) noexcept : before_(detail::present_stop) {
    detail::present_stop = flag;
  }
  ~Stoppable() { detail::present_stop = before_; }
  Stoppable(const Stoppable&) = delete;
  Stoppable& operator=(const Stoppable&) = delete;

  /// The flag of the present work on this thread.
  static const StopFlag* present() noexcept { return detail::present_stop; }

 private:
  const StopFlag* before_;
};

/// Whether the work on this thread is to stop. A loop that may take more than some milliseconds
/// polls this in each iteration and may end anywhere; its incomplete result is discarded by the
/// caller that made the work stoppable, which polls last. Costs two loads.
inline bool stop_requested() noexcept {
  const StopFlag* flag = detail::present_stop;
  return flag && flag->requested();
}

/// The error of functions that were stopped.
Error stopped_error();

}  // namespace tumble
