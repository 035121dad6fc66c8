#pragma once
#include "viewer/ui/panel.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace tumble {

/// The least of 1, 2, 5 times a power of ten of which at most `lines` fit into `range`.
double round_step(double range, double lines);

/// A curve over time; its samples are somebody else's.
struct PlottedCurve {
  std::string_view label, unit;
  uint32_t colour = 0;
  std::span<const double> at;  ///< ascending [s]
  std::span<const float> values;
};

/// Curves over one axis of time, each with an axis of values of its own in its colour; those of
/// one unit share theirs. A line stands at the moment that is shown; the pointer reads times and
/// values, and a click goes there.
void plot_over_time(PanelContext& context, std::string_view name,
                    std::span<const PlottedCurve> curves, float height);

/// One quantity against another, at the moments that both have; a dot stands at the moment that is
/// shown. The pointer reads the nearest point, and a click goes to its moment.
void plot_phase(PanelContext& context, std::string_view name, const PlottedCurve& across,
                const PlottedCurve& up, float height);

}  // namespace tumble
