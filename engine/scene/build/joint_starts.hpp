#pragma once
#include "engine/scene/build.hpp"

#include <string>
#include <vector>

namespace tumble {

/// Joints that do not begin as they are to be: coordinates beyond their limits or off what couples
/// them, and velocities of bodies that joints do not allow. Sentences that say by how much, and
/// what the run does about it.
std::vector<std::string> joint_start_warnings(const BuiltScene& built);

}  // namespace tumble
