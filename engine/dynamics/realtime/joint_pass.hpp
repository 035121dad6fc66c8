#pragma once
#include <cstdint>

namespace tumble {

/// Passes of a sub-step: onto the joints, then velocities along them.
enum class JointPass : uint8_t { moving, relaxing };

}  // namespace tumble
