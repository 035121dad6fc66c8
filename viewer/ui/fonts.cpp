#include "viewer/ui/fonts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <imgui.h>

namespace tumble {
namespace {

namespace fs = std::filesystem;

constexpr float body_size = 15, small_size = 13, large_size = 21;  // line heights in UI units

// Latin-1, Greek letters for physics, dashes and dots.
constexpr ImWchar glyph_ranges[] = {0x0020, 0x00FF, 0x0391, 0x03C9, 0x2010, 0x2026, 0};

ImFont* add_face(ImFontAtlas& atlas, const fs::path& file, float units, double scale) {
  ImFontConfig config;
  config.OversampleH = 2;
  config.OversampleV = 1;
  const auto pixels = float(std::round(units * scale));
  if (!file.empty()) {
    if (ImFont* font = atlas.AddFontFromFileTTF(file.c_str(), pixels, &config, glyph_ranges))
      return font;
  }
  // The built-in face is a 13-pixel bitmap: only whole multiples look right.
  config.OversampleH = 1;
  config.PixelSnapH = true;
  config.SizePixels = 13.0f * std::max(1.0f, std::floor(pixels / 13));
  return atlas.AddFontDefault(&config);
}

}  // namespace

std::vector<FontFace> font_candidates() {
  std::vector<FontFace> faces;
  if (const char* own = std::getenv("TUMBLE_FONT"); own && *own) faces.push_back({own, own});
  const fs::path root = "/usr/share/fonts/truetype";
  for (const char* folder : {"roboto/unhinted/RobotoTTF", "roboto/hinted", "roboto"})
    faces.push_back({root / folder / "Roboto-Regular.ttf", root / folder / "Roboto-Medium.ttf"});
  faces.push_back({root / "dejavu/DejaVuSans.ttf", root / "dejavu/DejaVuSans-Bold.ttf"});
  faces.push_back({root / "noto/NotoSans-Regular.ttf", root / "noto/NotoSans-Medium.ttf"});
  faces.push_back({root / "liberation/LiberationSans-Regular.ttf",
                   root / "liberation/LiberationSans-Bold.ttf"});
  return faces;
}

UiFonts bake_ui_fonts(ImFontAtlas& atlas, double scale) {
  UiFonts fonts;
  fs::path strong;
  for (const FontFace& face : font_candidates()) {
    std::error_code ignored;
    if (!fs::is_regular_file(face.regular, ignored)) continue;
    fonts.file = face.regular;
    strong = fs::is_regular_file(face.strong, ignored) ? face.strong : face.regular;
    break;
  }
  atlas.Clear();
  atlas.TexGlyphPadding = 1;
  fonts.body = add_face(atlas, fonts.file, body_size, scale);
  fonts.strong = add_face(atlas, strong, body_size, scale);
  fonts.small = add_face(atlas, fonts.file, small_size, scale);
  fonts.large = add_face(atlas, strong, large_size, scale);
  atlas.Build();
  return fonts;
}

FontAtlas renderer_atlas(ImFontAtlas& atlas, const UiFonts& fonts) {
  FontAtlas out;
  unsigned char* pixels = nullptr;
  atlas.GetTexDataAsAlpha8(&pixels, &out.width, &out.height);
  out.coverage.assign(pixels, pixels + size_t(out.width) * size_t(out.height));
  out.line_height = fonts.body->FontSize;
  out.white_u = atlas.TexUvWhitePixel.x;
  out.white_v = atlas.TexUvWhitePixel.y;
  for (const ImFontGlyph& g : fonts.body->Glyphs)
    out.glyphs.push_back(
        {uint32_t(g.Codepoint), g.X0, g.Y0, g.X1, g.Y1, g.U0, g.V0, g.U1, g.V1, g.AdvanceX});
  std::sort(out.glyphs.begin(), out.glyphs.end(),
            [](const Glyph& a, const Glyph& b) { return a.codepoint < b.codepoint; });
  return out;
}

}  // namespace tumble
