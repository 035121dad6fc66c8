#pragma once
#include <memory>
#include <vector>

namespace tumble {

struct Frame;

/// Observes every tick of a session's world, on the thread that steps it. Its results are read from
/// other threads, so implementations must lock.
class TickWatcher {
 public:
  virtual ~TickWatcher() = default;
  /// Called after a tick.
  virtual void see(const Frame& frame) = 0;
  /// Called when the world was set to another moment of its history, or to its first: later ticks
  /// have not happened (any more).
  virtual void go_to(const Frame& frame) = 0;
};
using TickWatchers = std::vector<std::shared_ptr<TickWatcher>>;

}  // namespace tumble
