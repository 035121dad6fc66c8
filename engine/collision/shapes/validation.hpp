#pragma once
#include "engine/core/result.hpp"

#include <string_view>

namespace tumble {

/// Largest length that a shape may have [m]; keeps squares and volumes finite.
constexpr double max_shape_size = 1e6;
/// Smallest radius or extent [m].
constexpr double min_shape_size = 1e-6;

/// "radius must be > 0, got -1 m", also for values that are not finite, too small or too large.
Status require_positive(std::string_view name, double metres);
/// The same, with zero allowed.
Status require_not_negative(std::string_view name, double metres);

}  // namespace tumble
