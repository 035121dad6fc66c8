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

/// Where each label stands, so that none covers another; nothing for one that is not in the picture
/// or finds no room. Greedy placement over a fixed set of candidates (Christensen, Marks and
/// Shieber 1995), in the order of the list: the free place next to the label's own, up to about its
/// own size away. Labels at pixels stay where they are, and the others make way.
std::vector<std::optional<LabelBox>> place_labels(const std::vector<TextLabel>& labels,
                                                  const FontAtlas& font, const Camera& camera,
                                                  int width, int height, float ui_scale);

/// Puts the letters of the labels that have a place into `ui` (pixels), in the font's texture.
void add_labels(const std::vector<TextLabel>& labels, const FontAtlas& font, const Camera& camera,
                int width, int height, float ui_scale, UiDrawList& ui);

/// Width of a text in pixels at a line height.
float text_width(std::string_view text, const FontAtlas& font, float size);

}  // namespace tumble
