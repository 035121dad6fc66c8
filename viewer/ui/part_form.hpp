#pragma once
#include "engine/scene/description/part.hpp"
#include "viewer/ui/panel.hpp"

#include <string>

namespace tumble {

/// Draws widgets for every value of an emitter, sensor, force or particle system, with units,
/// ranges and help. Optional values can be set and unset, and lists extended and shortened. Changes
/// are requested from the application. Widgets are named "part.KEY", in nested objects
/// "part.speed.mean", in lists "part.cloth.0.rows".
void draw_part_form(PanelContext& context, const std::string& name, const PartDescription& part);

}  // namespace tumble
