#pragma once
#include "engine/scene/description/part.hpp"
#include "viewer/ui/panel.hpp"

#include <string>

namespace tumble {

/// Widgets for every value of an emitter, sensor, force or particle system, with units, ranges and
/// help; what is not given can be given, lists grow and shrink. Asks for the change. Widgets are
/// marked "part.KEY", of inner objects "part.speed.mean", of lists "part.cloth.0.rows".
void draw_part_form(PanelContext& context, const std::string& name, const PartDescription& part);

}  // namespace tumble
