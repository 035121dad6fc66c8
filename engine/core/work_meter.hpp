#pragma once
#include "engine/core/stop.hpp"

#include <cstddef>
#include <cstdint>

namespace tumble {

/// Counts the work of a computation in one unit, where it is done: a multiplication with an
/// addition in a loop over matrices, and of anything else as many of these as take about as long.
/// A count and no clock: the same on every machine, in every run.
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

/// While it lives, what this thread does is charged to a meter, and asked to stop
/// (stop_requested()) when it has done more than the meter allows; whoever metered it asks the
/// meter last of all and throws away what it left. A request to stop from elsewhere is passed on
/// with the next charge. Threads of a Crew are not metered with the thread that calls them: a loop
/// whose work is to count is called without a meter and gives each of its bodies one, so that what
/// one may do does not depend on who was first.
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
/// What the work of this thread is charged to; null: nobody counts.
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

/// To be called by whatever takes time, once for some microseconds of it. Costs a few loads.
inline void charge_work(uint64_t units) noexcept {
  if (Metered* present = detail::present_meter) present->charge(units);
}

/// The same for a product of counts.
inline void charge_work(size_t a, size_t b, size_t c = 1) noexcept {
  charge_work(uint64_t(a) * uint64_t(b) * uint64_t(c));
}

/// Whether work of about so many units is to be begun: not where the meter does not allow as much,
/// which is then charged with all of it, as it would only be broken off in the middle, nor after a
/// request to stop.
inline bool may_begin_work(uint64_t units) noexcept {
  Metered* present = detail::present_meter;
  if (present) present->charge(present->meter().allows(units) ? 0 : units);
  return !stop_requested();
}

}  // namespace tumble
