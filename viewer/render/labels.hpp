#pragma once
#include "viewer/render/camera.hpp"
#include "viewer/render/font.hpp"
#include "viewer/render/render_scene.hpp"

#include <optional>
#include <vector>

namespace tumble {

/// A rectangle of the picture [px], y down.
struct LabelBox {
  float x = 0, y = 0, width = 0, height = 0;
  bool overlaps(const LabelBox& other) const;
};

/// Positions of labels so that none overlaps another; empty for a label that is outside the picture
/// or finds no free position. Greedy placement over a fixed set of candidate positions
/// (Christensen, Marks and Shieber 1995), in the order of the list: the free candidate nearest to
/// the label's anchor, at most about the label's size away. Labels at pixels are placed first and
/// never moved.
std::vector<std::optional<LabelBox>> place_labels(const std::vector<TextLabel>& labels,
                                                  const FontAtlas& font, const Camera& camera,
                                                  int width, int height, float ui_scale);

/// Adds the glyphs of the placed labels to `ui` (pixels), in the font's texture.
void add_labels(const std::vector<TextLabel>& labels, const FontAtlas& font, const Camera& camera,
                int width, int height, float ui_scale, UiDrawList& ui);

/// Width of a text [px] at a line height.
float text_width(std::string_view text, const FontAtlas& font, float size);

}  // namespace tumble
