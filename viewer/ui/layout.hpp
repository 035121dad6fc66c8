#pragma once
#include "viewer/ui/panel.hpp"

#include <vector>

namespace tumble {

/// Positions of all panels for a picture of given size. Columns are at the left and right edge, and
/// the middle is left to the scene; nothing overlaps except centred panels, which cover the rest on
/// purpose.
struct UiLayout {
  UiRect top_bar;
  struct Placed {
    const PanelEntry* panel;
    UiRect rect;
    bool folded = false;  ///< only its heading is shown; a click on it opens it
  };
  std::vector<Placed> panels;
  UiRect free_area;  ///< what remains for the scene between the columns [UI units]
};

/// Heights follow the contents. If a column is too short for them, idle panels are left out, and
/// the tallest are shortened and scroll; if that is not enough, those raised longest ago are
/// folded, and finally left out. A lesson stays high enough to be read as long as other panels can
/// fold. A narrow picture has one column. Beside two pictures, idle panels take no column from
/// them.
UiLayout layout_ui(double width, double height, const UiState& state);

/// Whether a picture of this width [UI units] has room for panels at both edges; otherwise there is
/// one column, which covers much of the scene.
bool has_two_columns(double width);

/// Shares `available` among needs: each gets min(need, h) with the greatest h that fits.
std::vector<float> share_height(const std::vector<float>& preferred, float available);

}  // namespace tumble
