#pragma once
#include <cstdint>

namespace tumble {

/// Passes of a sub-step: onto the joints, then velocities along them.
enum class JointPass : uint8_t { moving, relaxing };

/// Turn of a body in a sub-step up to which joints follow it [rad]. Beyond it the impulses of the
/// sub-step before, which held each other in balance, push another way: where one alone would turn
/// such a body as fast again a joint starts without them. Joints between heavy bodies would else
/// throw a light one about, faster every time. Second derivatives of the joint's lines say nothing
/// of the end of such a sub-step either and are followed no farther.
inline constexpr double max_turn_per_substep = 0.3;

/// A joint that is not kept is brought together no faster than this along each of its rows [m/s],
/// [rad/s]: what was put together wrongly is corrected over ticks instead of being shot at. Joints
/// that are kept are off by millimetres, which are worked off at a hundredth of it.
inline constexpr double max_joint_correction = 10;

}  // namespace tumble
