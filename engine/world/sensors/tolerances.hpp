#pragma once

namespace tumble::tolerances {

/// Gap up to which bodies that touched count as still touching, in units of g h^2 [-]. Two bodies
/// that separate and fall back within three ticks of h are apart by at most g (3 h)^2 / 8: such
/// rattling of bodies that rest or roll is not a new touch.
inline constexpr double rattle_gap = 9.0 / 8.0;

}  // namespace tumble::tolerances
