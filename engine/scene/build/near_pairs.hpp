#pragma once
#include "engine/math/types.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace tumble {

/// Pairs of points at most `reach` > 0 apart [m], up to rounding (1e-9 of it), as indices a < b in
/// ascending order. Nothing where there are more than `most`: that is found out after a time and in
/// an amount of memory that grow with `most` and the number of points, not with that of the pairs.
std::optional<std::vector<std::pair<uint32_t, uint32_t>>> near_pairs(std::span<const Vec3> points,
                                                                     double reach, size_t most);

}  // namespace tumble
