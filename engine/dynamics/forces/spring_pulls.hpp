#pragma once
#include "engine/dynamics/forces/spring.hpp"
#include "engine/dynamics/forces/spring_net.hpp"

#include <span>
#include <vector>

namespace tumble {

/// What springs do over a tick, each net of connected springs solved by itself and at once:
/// `out[i]` is the pull of springs[i], nothing where an end is gone. Other forces must be in the
/// sums by then; the pulls are not added to them. `supported`, by body slot, is not 0 where
/// contacts or joints held the body in the tick before: springs expect gravity and other forces to
/// move only what is free. None: all are.
void pull_springs(std::span<const SpringDef* const> springs, const ForceContext& context,
                  std::span<const uint8_t> supported, std::vector<SpringNet::Pull>& out);

/// Adds a pull to the force and torque sums of what the spring is tied to.
void add_pull(const SpringDef& spring, const SpringNet::Pull& pull, ForceContext& context);

}  // namespace tumble
