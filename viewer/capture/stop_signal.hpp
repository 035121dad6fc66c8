#pragma once
#include "engine/core/stop.hpp"

namespace tumble {

/// Turns Ctrl-C and SIGTERM into a request to stop: between two files, and within a tick for a
/// world that is given flag(). While an object of this class exists, the first signal only sets the
/// request; a second one ends the program at once, though no incomplete file has its final name.
/// Destruction restores the former handlers. At most one object at a time.
class StopSignal {
 public:
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  /// Whether a signal has come.
  bool requested() const;
  /// The same as a flag for computations to poll.
  const StopFlag& flag() const;
  /// 130 after Ctrl-C, 143 after SIGTERM, 0 without a signal.
  int exit_code() const;
};

}  // namespace tumble
