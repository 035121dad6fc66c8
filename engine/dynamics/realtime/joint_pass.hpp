#pragma once
#include <cstdint>

namespace tumble {

/// Passes of a sub-step: onto the joints, then velocities along them.
enum class JointPass : uint8_t { moving, relaxing };

/// A body whirls that turns farther than this in a sub-step [rad]. The impulses of the sub-step
/// before, which held each other in balance, push another way by then: where one alone would turn
/// such a body as fast again a joint starts without. Joints between heavy bodies would else throw a
/// light one about, faster every time.
inline constexpr double whirling = 0.3;

}  // namespace tumble
