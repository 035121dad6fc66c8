#pragma once
#include "engine/world/frame.hpp"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// The recent past of a run, for curves and bars: one sample a published tick, the latest
/// `capacity` of them. Going back in time forgets what lies ahead.
class History {
 public:
  static constexpr size_t capacity = 480;

  struct Sample {
    uint64_t tick = 0;
    double time = 0;  ///< [s]
    Energies energies;
    /// What each line of the ledger, and in the last place all forces, did to the energy [J].
    std::array<float, ledger_lines + 1> ledger{};
    double step_seconds = 0;  ///< sum of the stages [s]
  };
  struct Stage {
    std::string name;
    double smoothed = 0;  ///< [s]
  };

  void add(const Frame& frame);
  void clear();
  const std::vector<Sample>& samples() const { return samples_; }  ///< oldest first
  /// In the order of the step.
  const std::vector<Stage>& stages() const { return stages_; }
  double smoothed_step() const;  ///< [s]

 private:
  std::vector<Sample> samples_;
  std::vector<Stage> stages_;
};

}  // namespace tumble
