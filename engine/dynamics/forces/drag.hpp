#pragma once
#include "engine/dynamics/forces/force.hpp"

namespace tumble {

void apply(const LinearDragDef& def, ForceContext& context);
void apply(const QuadraticDragDef& def, ForceContext& context);

}  // namespace tumble
