#pragma once
#include "viewer/ui/panel.hpp"

namespace tumble {

/// Which handles stand at the selected bodies, how they snap, and numbers in place of a drag.
void draw_arrange_form(PanelContext& context);

}  // namespace tumble
