#pragma once
#include <functional>

namespace tumble {

/// Receives the completed share of a piece of work, from 0 to 1.
using ProgressSink = std::function<void(double share)>;

namespace detail {
/// The sink of the work on this thread; null: none.
inline thread_local constinit const ProgressSink* present_watcher = nullptr;
}  // namespace detail

/// During its life, work on this thread reports its progress to a sink, without a parameter in the
/// functions in between. Threads of a Crew that help do not report.
class Watched {
 public:
  /// The sink must outlive it; null: no reports.
  explicit Watched(const ProgressSink* sink) noexcept : before_(detail::present_watcher) {
    detail::present_watcher = sink;
  }
  ~Watched() { detail::present_watcher = before_; }
  Watched(const Watched&) = delete;
  Watched& operator=(const Watched&) = delete;

 private:
  const ProgressSink* before_;
};

/// To be called by work that takes seconds, several times per second.
inline void tell_progress(double share) {
  if (const ProgressSink* sink = detail::present_watcher) (*sink)(share);
}

}  // namespace tumble
