#pragma once
#include "engine/core/stop.hpp"

namespace tumble {

/// Ctrl-C and SIGTERM as a request to stop: between two files, and within a tick of a world that
/// stops with flag(). While one of these lives, the first
/// signal is only noted; a second one ends the program at once, still without half a file under a
/// final name. The earlier handling comes back at the end of its life. At most one at a time.
class StopSignal {
 public:
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  /// True once a signal has come.
  bool requested() const;
  /// The same for what asks in the midst of its work.
  const StopFlag& flag() const;
  /// 130 after Ctrl-C, 143 after SIGTERM, 0 when neither came.
  int exit_code() const;
};

}  // namespace tumble
