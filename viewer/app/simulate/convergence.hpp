#pragma once
#include "engine/core/stop.hpp"
#include "viewer/app/scenes/load_scene.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// How one quantity at the end of a run depends on the tick h.
struct ConvergenceRow {
  std::string name, unit;
  /// |value(h) - value(h/2)| and |value(h/2) - value(h/4)|: the greatest over bodies and particles.
  std::array<double, 2> difference{};
  /// log2 of their quotient; nothing where a difference is not above rounding.
  std::optional<double> order;
  /// Estimated errors at h, h/2, h/4 (Richardson): what is left of a series in h^order.
  std::array<double, 3> error{};
};

struct ConvergenceReport {
  std::array<double, 3> tick{};  ///< [s]
  double seconds = 0;            ///< simulated in each run [s]
  std::vector<ConvergenceRow> rows;
  std::array<double, 3> drift{};      ///< Ledger::drift() of each run [-]
  std::optional<double> drift_order;  ///< by the last two
};

/// Runs a scene with its tick, half of it and a quarter of it, over the same time: `ticks` of the
/// first. Errors: those of loading and of steps; `cancelled` once `stop`, which may be null, is
/// requested.
Result<ConvergenceReport> measure_convergence(const SceneRequest& request, uint64_t ticks,
                                              const StopFlag* stop = nullptr);

/// A table for people.
std::string convergence_text(const ConvergenceReport& report);

}  // namespace tumble
