#pragma once
#include "engine/core/stop.hpp"
#include "viewer/app/scenes/load_scene.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// Dependence of one quantity at the end of a run on the tick h.
struct ConvergenceRow {
  std::string name, unit;
  /// value(h) - value(h/2)| and |value(h/2) - value(h/4)|, the greatest over bodies and particles.
  std::array<double, 2> difference{};
  /// Observed order: log2 of the quotient of the two; empty if a difference is within rounding.
  std::optional<double> order;
  /// Estimated errors at h, h/2, h/4 by Richardson extrapolation for an error proportional to
  /// h^order.
  std::array<double, 3> error{};
};

struct ConvergenceReport {
  std::array<double, 3> tick{};  ///< [s]
  double seconds = 0;            ///< simulated in each run [s]
  std::vector<ConvergenceRow> rows;
  std::array<double, 3> drift{};      ///< Ledger::drift() of each run [-]
  std::optional<double> drift_order;  ///< observed order of the last two
};

/// Runs a scene with its tick h, with h/2 and with h/4 over the same time (`ticks` of the first).
/// Errors: those of loading and of steps; `cancelled` once `stop`, which may be null, is requested.
Result<ConvergenceReport> measure_convergence(const SceneRequest& request, uint64_t ticks,
                                              const StopFlag* stop = nullptr);

/// The report as a table.
std::string convergence_text(const ConvergenceReport& report);

}  // namespace tumble
