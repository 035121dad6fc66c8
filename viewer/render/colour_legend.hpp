#pragma once
#include "viewer/render/font.hpp"
#include "viewer/render/ui_draw_list.hpp"

#include <array>
#include <string>
#include <vector>

namespace tumble {

/// The legend of a colour map in a picture: a title with its unit over a bar of the colours with
/// numbers.
struct ColourLegend {
  std::string title;
  std::string unit;
  double low = 0, high = 1;
};

/// Puts legends one above the other at the lower right of an area of the picture [px: left, top,
/// right, bottom], drawn with the font's texture. They grow with the picture's height [px].
void add_legends(const std::vector<ColourLegend>& legends, const FontAtlas& font,
                 const std::array<float, 4>& area, int height, float ui_scale, UiDrawList& ui);

}  // namespace tumble
