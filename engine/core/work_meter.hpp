#pragma once
#include "engine/core/stop.hpp"

#include <cstddef>
#include <cstdint>

namespace tumble {

/// Counts the work of a computation, in units of about one multiplication with an addition in a
/// loop over matrices. A count instead of a clock, so that it is the same on every machine and in
/// every run.
class WorkMeter {
 public:
  static constexpr uint64_t any_amount = ~uint64_t{0};

  explicit WorkMeter(uint64_t allowed = any_amount) noexcept : allowed_(allowed) {}

  void charge(uint64_t units) noexcept { spent_ += units; }
  uint64_t spent() const noexcept { return spent_; }
  bool exhausted() const noexcept { return spent_ > allowed_; }
  bool allows(uint64_t more) const noexcept { return !exhausted() && more <= allowed_ - spent_; }

 private:
  uint64_t allowed_, spent_ = 0;
};

/// During its life, work on this thread is charged to a meter, and is asked to stop
/// (stop_requested()) when it exceeds the meter's limit; the code that metered it checks the meter
/// at the end and discards an incomplete result. A request to stop from elsewhere is passed on with
/// the next charge. Threads of a Crew are not metered with the thread that calls them: for a loop
/// whose work is to count, each iteration has a meter of its own, so that its limit does not depend
/// on the order of execution.
class Metered {
 public:
  explicit Metered(WorkMeter& meter) noexcept;
  ~Metered();
  Metered(const Metered&) = delete;
  Metered& operator=(const Metered&) = delete;

  void charge(uint64_t units) noexcept {
    meter_.charge(units);
    if (meter_.exhausted() || (outer_ && outer_->requested())) over_.request();
  }
  const WorkMeter& meter() const noexcept { return meter_; }

 private:
  WorkMeter& meter_;
  Metered* before_;
  const StopFlag* outer_;
  StopFlag over_;
  Stoppable scope_;
};

namespace detail {
/// The meter of the work on this thread; null: none.
inline thread_local constinit Metered* present_meter = nullptr;
}  // namespace detail

inline Metered::Metered(WorkMeter& meter) noexcept
    : meter_(meter),
      before_(detail::present_meter),
      outer_(before_ && Stoppable::present() == &before_->over_ ? before_->outer_
                                                                : Stoppable::present()),
      scope_(&over_) {
  detail::present_meter = this;
}

inline Metered::~Metered() {
  detail::present_meter = before_;
}

/// To be called by work at intervals of some microseconds. Costs a few loads.
inline void charge_work(uint64_t units) noexcept {
  if (Metered* present = detail::present_meter) present->charge(units);
}

/// The same for a product of counts.
inline void charge_work(size_t a, size_t b, size_t c = 1) noexcept {
  charge_work(uint64_t(a) * uint64_t(b) * uint64_t(c));
}

/// Whether work of about so many units may begin: not if it exceeds what the meter allows, in which
/// case the meter is charged with all of it, since the work would only be interrupted; nor after a
/// request to stop.
inline bool may_begin_work(uint64_t units) noexcept {
  Metered* present = detail::present_meter;
  if (present) present->charge(present->meter().allows(units) ? 0 : units);
  return !stop_requested();
}

}  // namespace tumble
