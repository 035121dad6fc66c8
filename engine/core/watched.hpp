#pragma once
#include <functional>

namespace tumble {

/// Gets how much of a piece of work is done, from 0 to 1.
using ProgressSink = std::function<void(double share)>;

namespace detail {
/// Who watches the work of this thread; null: nobody.
inline thread_local constinit const ProgressSink* present_watcher = nullptr;
}  // namespace detail

/// While it lives, what this thread does tells somebody how far it has got, without a word of it in
/// any signature in between. Threads of a Crew that help are not watched.
class Watched {
 public:
  /// The sink outlives it; null: nobody watches.
  explicit Watched(const ProgressSink* sink) noexcept : before_(detail::present_watcher) {
    detail::present_watcher = sink;
  }
  ~Watched() { detail::present_watcher = before_; }
  Watched(const Watched&) = delete;
  Watched& operator=(const Watched&) = delete;

 private:
  const ProgressSink* before_;
};

/// To be called by whatever takes seconds, a few times in each of them or more often.
inline void tell_progress(double share) {
  if (const ProgressSink* sink = detail::present_watcher) (*sink)(share);
}

}  // namespace tumble
