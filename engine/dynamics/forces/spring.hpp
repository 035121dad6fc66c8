#pragma once
#include "engine/dynamics/forces/force.hpp"

namespace tumble {

void apply(const SpringDef& def, ForceContext& context);
double potential_energy(const SpringDef& def, const ForceContext& context);

}  // namespace tumble
