#pragma once
#include "engine/world/frame.hpp"

#include <span>

namespace tumble {

/// Median radius of the dynamic bodies [m], half a metre if there are none; arrows are scaled by
/// it, so that they suit marbles and bridges alike.
double typical_size(const Frame& frame);

/// A body counts as flown away if it is this many times farther off than most others: a view of all
/// would show the others as dots of about three pixels [-].
constexpr double flown_away = 300;

/// The union of the boxes, except those that have flown away or are as large as that; boxes that
/// are not finite are ignored. "Most" of few boxes are the small and near ones.
Aabb bounds_of_most(std::span<const Aabb> boxes);

}  // namespace tumble
