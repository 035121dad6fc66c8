#pragma once
#include "engine/world/frame.hpp"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// The recent past of a run for curves and bars: one sample per published tick, the latest
/// `capacity` of them. Going back in time drops the samples after the new present.
class History {
 public:
  static constexpr size_t capacity = 480;

  struct Sample {
    uint64_t tick = 0;
    double time = 0;  ///< [s]
    Energies energies;
    /// Energy contributed by each line of the ledger, and in the last place by all forces [J].
    std::array<float, ledger_lines + 1> ledger{};
    double step_seconds = 0;  ///< wall time of all stages of the step [s]
  };
  struct Stage {
    std::string name;
    double smoothed = 0;  ///< [s]
  };

  void add(const Frame& frame);
  void clear();
  const std::vector<Sample>& samples() const { return samples_; }  ///< oldest first
  /// Stages in the order in which the step runs them.
  const std::vector<Stage>& stages() const { return stages_; }
  double smoothed_step() const;  ///< [s]

 private:
  std::vector<Sample> samples_;
  std::vector<Stage> stages_;
};

}  // namespace tumble
