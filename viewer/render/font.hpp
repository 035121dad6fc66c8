#pragma once
#include "engine/core/result.hpp"

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace tumble {

/// One character's rectangle in the atlas and on the line, in pixels of the baked size.
struct Glyph {
  uint32_t codepoint = 0;
  float x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< relative to pen and top of line, y down
  float u0 = 0, v0 = 0, u1 = 0, v1 = 0;
  float advance = 0;
};

/// A font drawn into one texture. Texels are coverage in alpha, white in colour.
struct FontAtlas {
  int width = 0, height = 0;
  std::vector<uint8_t> coverage;   ///< width * height
  float line_height = 13;          ///< [px]
  float white_u = 0, white_v = 0;  ///< a texel of full coverage, for plain shapes
  std::vector<Glyph> glyphs;       ///< sorted by codepoint

  const Glyph* find(uint32_t codepoint) const;
};

/// The font inside Dear ImGui (a 13-pixel bitmap; `pixels` should be a multiple of 13).
FontAtlas bake_default_font(float pixels = 13);
/// A TrueType file at a line height in pixels.
Result<FontAtlas> bake_font(const std::filesystem::path& ttf, float pixels);

/// Next code point of a UTF-8 string, advancing `s`; U+FFFD for a broken sequence.
uint32_t next_codepoint(std::string_view& s);

}  // namespace tumble
