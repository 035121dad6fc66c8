#pragma once
#include <chrono>
#include <cstdint>
#include <string_view>
#include <vector>

namespace tumble {

/// Wall time of one named stage of a step or of a frame. Never part of state, hash or snapshot.
struct StageTime {
  std::string_view name;  ///< a string literal
  double seconds = 0;     ///< [s]
};

/// Collects the times of consecutive stages: `ScopedStage s(profiler, "broad phase");`.
class Profiler {
 public:
  void clear() { stages_.clear(); }
  /// Adds to the stage of this name, or appends it.
  void add(std::string_view name, double seconds);
  const std::vector<StageTime>& stages() const { return stages_; }
  double total() const;

 private:
  std::vector<StageTime> stages_;
};

class ScopedStage {
 public:
  ScopedStage(Profiler& profiler, std::string_view name)
      : profiler_(profiler), name_(name), start_(std::chrono::steady_clock::now()) {}
  ~ScopedStage() {
    const auto d = std::chrono::steady_clock::now() - start_;
    profiler_.add(name_, std::chrono::duration<double>(d).count());
  }
  ScopedStage(const ScopedStage&) = delete;
  ScopedStage& operator=(const ScopedStage&) = delete;

 private:
  Profiler& profiler_;
  std::string_view name_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace tumble
