#pragma once
#include "engine/core/stage_times.hpp"

#include <chrono>
#include <string_view>

namespace tumble {

/// Collects the times of consecutive stages: `ScopedStage s(profiler, "broad phase");`.
class Profiler {
 public:
  void clear() { stages_.clear(); }
  /// Adds to the stage of this name, or appends it.
  void add(std::string_view name, double seconds) { stages_.add(name, seconds); }
  const StageTimes& stages() const { return stages_; }
  double total() const;

 private:
  StageTimes stages_;
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
