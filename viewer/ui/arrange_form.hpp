#pragma once
#include "viewer/ui/panel.hpp"

namespace tumble {

/// Draws the controls for the handles at the selected bodies: which handles, how they snap, and
/// fields to type a displacement instead of dragging.
void draw_arrange_form(PanelContext& context);

}  // namespace tumble
