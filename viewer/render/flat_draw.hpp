#pragma once
#include "viewer/render/font.hpp"
#include "viewer/render/ui_draw_list.hpp"

#include <string_view>

namespace tumble {

/// Plain 2D figures in pixels of the picture, drawn with the font's texture.
class FlatDraw {
 public:
  FlatDraw(UiDrawList& out, const FontAtlas& font) : out_(out), font_(font) {}

  void box(float x0, float y0, float x1, float y1, uint32_t rgba);
  void line(float x0, float y0, float x1, float y1, float width, uint32_t rgba);
  void triangle(float x0, float y0, float x1, float y1, float x2, float y2, uint32_t rgba);
  void disc(float x, float y, float radius, uint32_t rgba);
  /// Text with its top left corner at (x, y).
  void text(std::string_view text, float x, float y, float size, uint32_t rgba);

  const FontAtlas& font() const { return font_; }

 private:
  void corner(float x, float y, uint32_t rgba);

  UiDrawList& out_;
  const FontAtlas& font_;
};

}  // namespace tumble
