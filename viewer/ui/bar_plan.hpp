#pragma once

namespace tumble {

/// Widths that the parts of the top bar need [UI units].
struct BarWidths {
  float scene = 0;     ///< button with the scene's whole title
  float switches = 0;  ///< one word for each panel
  float menu = 0;      ///< the menu that replaces those words
};

/// Which parts of the top bar fit, and where. Nothing overlaps and nothing is cut off: as width
/// shrinks, the words for panels are replaced by a menu, then the speed and the step buttons are
/// left out, then the title is shortened.
struct BarPlan {
  float scene_x = 0, scene_width = 0;
  float transport_x = 0, transport_end = 0;
  bool steps = true;  ///< restart, back and forward buttons beside pause
  bool speed = true;
  bool switches = true;  ///< false: the menu instead
  float right_x = 0;     ///< where switches or the menu begin; the time ends before it
};
BarPlan plan_bar(float width, const BarWidths& widths);

}  // namespace tumble
