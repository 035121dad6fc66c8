#pragma once
#include "viewer/render/font.hpp"

#include <filesystem>
#include <vector>

struct ImFont;
struct ImFontAtlas;

namespace tumble {

/// The fonts of the panels, all in one atlas; never null once baked.
struct UiFonts {
  ImFont* body = nullptr;      ///< running text and numbers (figures of equal width)
  ImFont* strong = nullptr;    ///< titles
  ImFont* small = nullptr;     ///< hints, shortcuts
  ImFont* large = nullptr;     ///< the help's heading, the scene's name
  std::filesystem::path file;  ///< file of the regular font; empty: ImGui's built-in bitmap font
};

/// Font files that are tried, best first: $TUMBLE_FONT (a .ttf file), Roboto, DejaVu, Noto,
/// Liberation; each in a regular and a bold weight.
struct FontFace {
  std::filesystem::path regular, strong;
};
std::vector<FontFace> font_candidates();

/// Bakes the fonts at `scale` pixels per UI unit into an ImGui atlas. Without any font file,
/// ImGui's built-in bitmap font is used.
UiFonts bake_ui_fonts(ImFontAtlas& atlas, double scale);

/// The atlas in the renderer's format: UI texture 0, with the glyphs of `fonts.body` for labels.
FontAtlas renderer_atlas(ImFontAtlas& atlas, const UiFonts& fonts);

}  // namespace tumble
