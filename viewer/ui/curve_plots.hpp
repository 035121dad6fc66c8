#pragma once
#include "viewer/ui/panel.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace tumble {

/// The least step of 1, 2 or 5 times a power of ten that divides `range` into at most `lines`
/// intervals.
double round_step(double range, double lines);

/// A curve over time; it refers to samples owned elsewhere.
struct PlottedCurve {
  std::string_view label, unit;
  uint32_t colour = 0;
  std::span<const double> at;  ///< ascending [s]
  std::span<const float> values;
};

/// Plots curves over a common time axis. Each curve has a value axis in its colour; curves with the
/// same unit share one. A vertical line marks the time shown; the pointer reads times and values,
/// and a click seeks to that time.
void plot_over_time(PanelContext& context, std::string_view name,
                    std::span<const PlottedCurve> curves, float height);

/// Plots one quantity against another (phase plot) at the times that both have; a dot marks the
/// time shown. The pointer reads the nearest point, and a click seeks to its time.
void plot_phase(PanelContext& context, std::string_view name, const PlottedCurve& across,
                const PlottedCurve& up, float height);

}  // namespace tumble
