#pragma once
#include "engine/math/types.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace tumble {

/// The colour map viridis: perceived lightness rises evenly from dark violet to light yellow, so
/// that equal steps of a value look like equal steps, for colour-blind people too.
Vec3f viridis_srgb(double u);
/// Linear; 256 steps.
const std::array<Vec3f, 256>& viridis_table();
/// Of a value on a scale; beyond its ends the colours of the ends. Values that are no numbers are
/// grey.
Vec3f viridis_linear(double value, double low, double high);

/// Numbers at even steps of 1, 2 or 5 times a power of ten.
struct NiceScale {
  double low = 0, high = 1;
  double step = 0.2;
  std::vector<double> numbers() const;  ///< the multiples of `step` from `low` to `high`
};
/// The scale from `low` to `high`; `rounded`: from the multiple of a step below to that above.
/// Where both are the same it goes to either side of that.
NiceScale nice_scale(double low, double high, bool rounded);

}  // namespace tumble
