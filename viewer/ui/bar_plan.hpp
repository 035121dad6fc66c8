#pragma once

namespace tumble {

/// What the pieces of the top bar would like to have [UI units].
struct BarWidths {
  float scene = 0;     ///< button with the scene's whole title
  float switches = 0;  ///< one word for each panel
  float menu = 0;      ///< one word for all panels
};

/// What of the top bar there is room for, and where. Nothing overlaps and nothing is cut off: the
/// words of the panels give way to a menu, the speed and the step buttons go, the title shrinks.
struct BarPlan {
  float scene_x = 0, scene_width = 0;
  float transport_x = 0, transport_end = 0;
  bool steps = true;  ///< restart, back and forward beside pause
  bool speed = true;
  bool switches = true;  ///< else the menu
  float right_x = 0;     ///< where switches or the menu begin; time ends before
};
BarPlan plan_bar(float width, const BarWidths& widths);

}  // namespace tumble
