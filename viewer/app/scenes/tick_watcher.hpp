#pragma once
#include <memory>
#include <vector>

namespace tumble {

struct Frame;

/// Looks at every tick of a session's world, on the thread that steps it. What it has seen others
/// read from other threads: it locks.
class TickWatcher {
 public:
  virtual ~TickWatcher() = default;
  /// After a tick.
  virtual void see(const Frame& frame) = 0;
  /// The world is at another moment of its history, or at its first: what lies ahead has not
  /// happened.
  virtual void go_to(const Frame& frame) = 0;
};
using TickWatchers = std::vector<std::shared_ptr<TickWatcher>>;

}  // namespace tumble
