#pragma once
#include "viewer/render/font.hpp"

#include <filesystem>
#include <vector>

struct ImFont;
struct ImFontAtlas;

namespace tumble {

/// The faces of the panels; all in one atlas, never null once baked.
struct UiFonts {
  ImFont* body = nullptr;      ///< running text and numbers (figures of equal width)
  ImFont* strong = nullptr;    ///< titles
  ImFont* small = nullptr;     ///< hints, shortcuts
  ImFont* large = nullptr;     ///< the help's heading, the scene's name
  std::filesystem::path file;  ///< the regular face's; empty: ImGui's built-in bitmap
};

/// Places where a regular and a strong face are looked for, best first: $TUMBLE_FONT (a .ttf file),
/// Roboto, DejaVu, Noto, Liberation.
struct FontFace {
  std::filesystem::path regular, strong;
};
std::vector<FontFace> font_candidates();

/// Bakes the faces for `scale` pixels per UI unit into an ImGui atlas. A machine without any font
/// file gets ImGui's own bitmap.
UiFonts bake_ui_fonts(ImFontAtlas& atlas, double scale);

/// The atlas as the renderer takes it: UI texture 0, with the glyphs of `fonts.body` for labels.
FontAtlas renderer_atlas(ImFontAtlas& atlas, const UiFonts& fonts);

}  // namespace tumble
