#pragma once
#include <chrono>
#include <cstdint>
#include <string>

namespace tumble {

/// Progress on stderr with rate and remaining time: on a terminal a line that is rewritten,
/// otherwise a new line every few seconds.
class Progress {
 public:
  /// `first`: the number already done before.
  Progress(uint64_t total, uint64_t first);
  ~Progress() { finish(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(uint64_t done);
  /// Ends the line that is rewritten.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  bool terminal_;
  bool open_ = false;
  uint64_t total_, first_;
  Clock::time_point start_, last_;
};

/// The same for work that knows its completed share: prints what it does, and the remaining time
/// estimated from the time so far.
class WorkProgress {
 public:
  explicit WorkProgress(std::string what);
  ~WorkProgress() { finish(); }
  WorkProgress(const WorkProgress&) = delete;
  WorkProgress& operator=(const WorkProgress&) = delete;

  /// Shows the share, from 0 to 1; `more` is additional text.
  void show(double share, const std::string& more = {});
  /// Ends the line that is rewritten.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  std::string what_;
  bool terminal_;
  bool open_ = false;
  Clock::time_point start_, last_;
};

}  // namespace tumble
