#pragma once
#include "viewer/ui/panel.hpp"

namespace tumble {

/// The joints of the selected body: what their coordinates are, and what acts along them, to be
/// changed.
void draw_joint_form(PanelContext& context);

}  // namespace tumble
