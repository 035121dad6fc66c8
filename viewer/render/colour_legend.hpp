#pragma once
#include "viewer/render/font.hpp"
#include "viewer/render/ui_draw_list.hpp"

#include <array>
#include <string>
#include <vector>

namespace tumble {

/// What the colours of something in a picture mean: a title with its unit over a bar of the colour
/// map, with numbers.
struct ColourLegend {
  std::string title;
  std::string unit;
  double low = 0, high = 1;
};

/// Puts legends at the lower right of an area of the picture [px: left, top, right, bottom], one
/// above the other, in the font's texture. Grows with the picture.
void add_legends(const std::vector<ColourLegend>& legends, const FontAtlas& font,
                 const std::array<float, 4>& area, int height, float ui_scale, UiDrawList& ui);

}  // namespace tumble
