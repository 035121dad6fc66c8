#pragma once
#include "engine/dynamics/forces/force.hpp"

namespace tumble {

void apply(const MouseSpringDef& def, ForceContext& context);

}  // namespace tumble
