#pragma once
#include <chrono>
#include <cstdint>

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

}  // namespace tumble
