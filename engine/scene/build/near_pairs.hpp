#pragma once
#include "engine/math/types.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace tumble {

/// Pairs of points at most `reach` > 0 apart [m], up to rounding (1e-9 of it), as indices a < b in
/// ascending order. Empty if there are more than `most`; time and memory then grow with `most` and
/// the number of points, not with the number of pairs.
std::optional<std::vector<std::pair<uint32_t, uint32_t>>> near_pairs(std::span<const Vec3> points,
                                                                     double reach, size_t most);

}  // namespace tumble
