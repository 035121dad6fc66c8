#pragma once
#include "engine/math/types.hpp"

namespace tumble {

/// The orientation at fraction s in [0, 1] between a and b (unit quaternions), at constant angular
/// velocity along the shorter great circle (Shoemake 1985); a and -a are the same orientation. For
/// orientations half a turn apart both ways are equally short. The bits are the same on every
/// machine. Between the frames of ticks the cheaper interpolate() of rotation.hpp is used: the same
/// arc and ends, but for a rotation by a small angle w [rad] up to w^3 / 240 ahead or behind, which
/// is invisible within a tick.
Quat slerp(const Quat& a, const Quat& b, double s);
/// Position linearly, orientation by slerp.
Pose slerp(const Pose& a, const Pose& b, double s);

}  // namespace tumble
