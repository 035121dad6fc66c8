#pragma once
#include "engine/world/microscope/sketch.hpp"
#include "viewer/render/font.hpp"
#include "viewer/render/ui_draw_list.hpp"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tumble {

/// Text and a diagram laid over a picture: a caption along its lower edge, numbers at the top left,
/// the diagram at the top right. Sizes grow with the picture, so that it is readable at any size.
struct Plate {
  std::string heading;  ///< before the title: the algorithm whose steps are shown
  std::string title;
  std::string counter;  ///< "3 / 12"
  std::string caption;
  std::vector<std::pair<std::string, std::string>> numbers;  ///< label and value
  Diagram diagram;
  float top = 0;  ///< numbers and diagram start below this, since something else is above [px]
};

/// Adds a plate to `ui` (pixels), drawn with the font's texture.
void add_plate(const Plate& plate, const FontAtlas& font, int width, int height, float ui_scale,
               UiDrawList& ui);

/// Breaks a text into lines no wider than `width` [px] at a line height `size` [px]; words longer
/// than a line are broken too.
std::vector<std::string> wrapped(std::string_view text, const FontAtlas& font, float size,
                                 float width);

}  // namespace tumble
