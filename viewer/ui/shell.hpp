#pragma once
#include "viewer/ui/layout.hpp"

namespace tumble {

/// Draws the whole interface: bars, docked panels with headings, centred panels, messages. To be
/// called between UiHost::begin() and end(). Returns the area left free for the scene.
UiRect draw_ui(PanelContext& context, double width, double height);

}  // namespace tumble
