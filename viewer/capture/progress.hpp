#pragma once
#include <chrono>
#include <cstdint>
#include <string>

namespace tumble {

/// Progress on stderr: one line that is rewritten on a terminal, else a plain line every few
/// seconds, with rate and time left.
class Progress {
 public:
  /// `first`: already done before.
  Progress(uint64_t total, uint64_t first);
  ~Progress() { finish(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(uint64_t done);
  /// Ends the rewritten line.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  bool terminal_;
  bool open_ = false;
  uint64_t total_, first_;
  Clock::time_point start_, last_;
};

/// The same of work that knows which share of it is done: what it does, and the time left by what
/// it took so far.
class WorkProgress {
 public:
  explicit WorkProgress(std::string what);
  ~WorkProgress() { finish(); }
  WorkProgress(const WorkProgress&) = delete;
  WorkProgress& operator=(const WorkProgress&) = delete;

  /// `share` from 0 to 1; `more`: what else there is to say of it.
  void show(double share, const std::string& more = {});
  /// Ends the rewritten line.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  std::string what_;
  bool terminal_;
  bool open_ = false;
  Clock::time_point start_, last_;
};

}  // namespace tumble
