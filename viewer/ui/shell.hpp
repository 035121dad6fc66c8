#pragma once
#include "viewer/ui/layout.hpp"

namespace tumble {

/// Draws all that is visible: bars, docked panels with their headings, centred panels, messages.
/// Between UiHost::begin() and end(). Returns where the scene is free.
UiRect draw_ui(PanelContext& context, double width, double height);

}  // namespace tumble
