#pragma once
#include "engine/core/result.hpp"

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace tumble {

/// Rectangle of a character in the atlas and relative to the pen, in pixels of the baked size.
struct Glyph {
  uint32_t codepoint = 0;
  float x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< relative to pen and top of line, y down
  float u0 = 0, v0 = 0, u1 = 0, v1 = 0;
  float advance = 0;
};

/// A font rasterised into one texture. Texels are white, with the coverage in alpha.
struct FontAtlas {
  int width = 0, height = 0;
  std::vector<uint8_t> coverage;   ///< width * height
  float line_height = 13;          ///< [px]
  float white_u = 0, white_v = 0;  ///< a texel with full coverage, for plain shapes
  std::vector<Glyph> glyphs;       ///< sorted by codepoint

  const Glyph* find(uint32_t codepoint) const;
};

/// The font embedded in Dear ImGui (a bitmap font of 13 pixels; `pixels` should be a multiple of
/// 13).
FontAtlas bake_default_font(float pixels = 13);
/// Rasterises a TrueType file at a line height in pixels.
Result<FontAtlas> bake_font(const std::filesystem::path& ttf, float pixels);

/// The next code point of a UTF-8 string, which is removed from `s`; U+FFFD for an invalid
/// sequence.
uint32_t next_codepoint(std::string_view& s);

}  // namespace tumble
