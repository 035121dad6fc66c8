#pragma once
#include "engine/scene/build.hpp"

#include <string>
#include <vector>

namespace tumble {

/// Messages about joints that do not start consistently: coordinates beyond their limits or that
/// violate couplings, and velocities of bodies that joints do not allow, with the amount, and how
/// the run treats it.
std::vector<std::string> joint_start_warnings(const BuiltScene& built);

}  // namespace tumble
