#pragma once
#include "viewer/ui/panel.hpp"

namespace tumble {

/// Draws editable fields for the joints of the selected body: their coordinates, and the limits,
/// motors, springs and friction along them.
void draw_joint_form(PanelContext& context);
/// Draws one of these values of any joint, if it has it; false if not. Its widget is called by
/// `mark` and the pin's value.
bool draw_pinned_joint_value(PanelContext& context, const Pin& pin, const std::string& mark,
                             const SelectedJoint& joint);

}  // namespace tumble
