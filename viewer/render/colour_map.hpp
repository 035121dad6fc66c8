#pragma once
#include "engine/math/types.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace tumble {

/// The colour map viridis: perceived lightness rises evenly from dark violet to light yellow, so
/// that equal steps of a value look like equal steps, for colour-blind people too.
Vec3f viridis_srgb(double u);
/// viridis in linear RGB at 256 even steps.
const std::array<Vec3f, 256>& viridis_table();
/// The colour of a value on a scale. Values beyond an end have the colour of that end; values that
/// are not a number are grey.
Vec3f viridis_linear(double value, double low, double high);

/// A scale with numbers at even steps of 1, 2 or 5 times a power of ten.
struct NiceScale {
  double low = 0, high = 1;
  double step = 0.2;
  std::vector<double> numbers() const;  ///< the multiples of `step` from `low` to `high`
};
/// The scale from `low` to `high`; if `rounded`, both ends are moved outwards to multiples of the
/// step. If low equals high, the scale extends to both sides of that value.
NiceScale nice_scale(double low, double high, bool rounded);

}  // namespace tumble
