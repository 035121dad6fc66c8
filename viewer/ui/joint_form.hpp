#pragma once
#include "viewer/ui/panel.hpp"

namespace tumble {

/// Draws editable fields for the joints of the selected body: their coordinates, and the limits,
/// motors, springs and friction along them.
void draw_joint_form(PanelContext& context);

}  // namespace tumble
