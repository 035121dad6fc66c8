#pragma once
#include "engine/world/frame.hpp"

#include <span>

namespace tumble {

/// Typical radius of a dynamic body [m], so that arrows suit marbles and bridges alike: the median;
/// half a metre where there are none.
double typical_size(const Frame& frame);

/// What is this many times farther away than most of the others would, seen with them, make them a
/// dot of three pixels: it has flown away.
constexpr double flown_away = 300;

/// The union of the boxes without those that have flown away, or that are so large; of what is not
/// finite nothing. With few boxes most are the small and near ones.
Aabb bounds_of_most(std::span<const Aabb> boxes);

}  // namespace tumble
