#pragma once
#include "engine/math/types.hpp"

namespace tumble {

/// The orientation a fraction s in [0, 1] of the way from a to b (unit quaternions), turning at
/// constant speed along the shorter great circle (Shoemake 1985); a and -a are the same
/// orientation. For orientations half a turn apart either way is as short. The bits are the same on
/// every machine. Frames between ticks take the cheaper interpolate() of rotation.hpp: the same arc
/// and ends, but for a turn by a small angle w [rad] up to w^3 / 240 ahead or behind, which within
/// a tick is not seen.
Quat slerp(const Quat& a, const Quat& b, double s);
/// Position linearly, orientation by slerp.
Pose slerp(const Pose& a, const Pose& b, double s);

}  // namespace tumble
