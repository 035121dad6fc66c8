#include "viewer/render/font.hpp"

#include <algorithm>

#include <imgui.h>

namespace tumble {

const Glyph* FontAtlas::find(uint32_t codepoint) const {
  const auto it = std::lower_bound(glyphs.begin(), glyphs.end(), codepoint,
                                   [](const Glyph& g, uint32_t c) { return g.codepoint < c; });
  return it != glyphs.end() && it->codepoint == codepoint ? &*it : nullptr;
}

namespace {

FontAtlas atlas_of(ImFontAtlas& source, const ImFont& font) {
  FontAtlas out;
  unsigned char* pixels = nullptr;
  source.GetTexDataAsAlpha8(&pixels, &out.width, &out.height);
  out.coverage.assign(pixels, pixels + size_t(out.width) * size_t(out.height));
  out.line_height = font.FontSize;
  out.white_u = source.TexUvWhitePixel.x;
  out.white_v = source.TexUvWhitePixel.y;
  for (const ImFontGlyph& g : font.Glyphs)
    out.glyphs.push_back(
        {uint32_t(g.Codepoint), g.X0, g.Y0, g.X1, g.Y1, g.U0, g.V0, g.U1, g.V1, g.AdvanceX});
  std::sort(out.glyphs.begin(), out.glyphs.end(),
            [](const Glyph& a, const Glyph& b) { return a.codepoint < b.codepoint; });
  return out;
}

}  // namespace

FontAtlas bake_default_font(float pixels) {
  ImFontAtlas atlas;
  ImFontConfig config;
  config.SizePixels = pixels;
  config.OversampleH = config.OversampleV = 1;
  config.PixelSnapH = true;
  ImFont* font = atlas.AddFontDefault(&config);
  atlas.Build();
  return atlas_of(atlas, *font);
}

Result<FontAtlas> bake_font(const std::filesystem::path& ttf, float pixels) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(ttf, ignored))
    return Error{ErrorCode::not_found, "no such font file", ttf.string(), ""};
  ImFontAtlas atlas;
  ImFont* font = atlas.AddFontFromFileTTF(ttf.c_str(), pixels);
  if (!font || !atlas.Build())
    return Error{ErrorCode::parse, "not a TrueType font", ttf.string(), "give a .ttf file"};
  return atlas_of(atlas, *font);
}

uint32_t next_codepoint(std::string_view& s) {
  constexpr uint32_t bad = 0xFFFD;
  if (s.empty()) return 0;
  const auto byte = [&](size_t i) { return uint32_t(uint8_t(s[i])); };
  const uint32_t lead = byte(0);
  const size_t length = lead < 0x80       ? 1
                        : lead >> 5 == 6  ? 2
                        : lead >> 4 == 14 ? 3
                        : lead >> 3 == 30 ? 4
                                          : 0;
  if (length == 0 || length > s.size()) {
    s.remove_prefix(1);
    return bad;
  }
  uint32_t c = length == 1 ? lead : lead & (0xFFu >> (length + 1));
  for (size_t i = 1; i < length; ++i) {
    if (byte(i) >> 6 != 2) {
      s.remove_prefix(i);
      return bad;
    }
    c = c << 6 | (byte(i) & 63u);
  }
  s.remove_prefix(length);
  return c;
}

}  // namespace tumble
