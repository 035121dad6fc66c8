#pragma once

namespace tumble::tolerances {

/// Who touched stays in touch up to gaps of so many g h^2 [-]. Two bodies that part and fall back
/// within three ticks of h are apart by g (3 h)^2 / 8 at most; that is the rattling of what rests
/// or rolls and no new touch.
inline constexpr double rattle_gap = 9.0 / 8.0;

}  // namespace tumble::tolerances
