#pragma once
#include "viewer/ui/panel.hpp"

#include <vector>

namespace tumble {

/// Where everything is on a picture of given size. The columns stand at the edges and the middle is
/// left to the scene; nothing overlaps (centred panels lie over the rest on purpose).
struct UiLayout {
  UiRect top_bar;
  struct Placed {
    const PanelEntry* panel;
    UiRect rect;
    bool folded = false;  ///< its heading only: a click there opens it
  };
  std::vector<Placed> panels;
  UiRect free_area;  ///< of the scene, between the columns [UI units]
};

/// Heights follow the contents; where a column is too short for them, the tallest give way and
/// scroll. Where even that leaves too little, those that were raised longest ago are folded, and at
/// the last left out. A narrow picture has one column.
UiLayout layout_ui(double width, double height, const UiState& state);

/// Whether panels at both edges leave room for the scene; else there is one column, which covers
/// much of it.
bool has_two_columns(double width);

/// Shares `available` among wishes: everybody gets min(wish, h) with the greatest h that fits.
std::vector<float> share_height(const std::vector<float>& wishes, float available);

}  // namespace tumble
