#include "viewer/render/colour_legend.hpp"

#include "viewer/render/colour_map.hpp"
#include "viewer/render/flat_draw.hpp"
#include "viewer/render/labels.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

constexpr uint32_t legend_ground = 0xB020180Fu, legend_letters = 0xFFF2EEEAu;

uint32_t bytes_of_srgb(const Vec3f& c) {
  const auto byte = [](float x) { return uint32_t(x * 255 + 0.5f); };
  return 0xFF000000u | byte(c.z()) << 16 | byte(c.y()) << 8 | byte(c.x());
}

/// One legend with its lower right corner at (right, bottom); gives its height.
float add_legend(const ColourLegend& legend, float right, float bottom, float unit, float widest,
                 FlatDraw& draw) {
  const float text = 13 * unit, pad = std::floor(7 * unit), bar_height = std::floor(10 * unit);
  const std::string title =
      legend.unit.empty() ? legend.title : fmt::format("{} [{}]", legend.title, legend.unit);
  const float inner =
      std::max(std::floor(std::min(200 * unit, widest)), text_width(title, draw.font(), text));
  // Half a number stands out to either side of the bar.
  const float side = std::floor(18 * unit);
  const float wide = inner + 2 * (pad + side), tall = 2 * pad + 2.2f * text + bar_height + pad;
  const float x0 = std::floor(right - wide), y0 = std::floor(bottom - tall);
  draw.box(x0, y0, x0 + wide, y0 + tall, legend_ground);
  draw.text(title, x0 + pad + side, y0 + pad, text, legend_letters);
  const float bar_x = x0 + pad + side, bar_y = std::floor(y0 + pad + 1.3f * text);
  constexpr int parts = 100;
  for (int i = 0; i < parts; ++i)
    draw.box(bar_x + inner * float(i) / parts, bar_y, bar_x + inner * float(i + 1) / parts,
             bar_y + bar_height, bytes_of_srgb(viridis_srgb((i + 0.5) / parts)));
  const NiceScale scale = nice_scale(legend.low, legend.high, false);
  const float tick = std::floor(4 * unit), numbers_y = bar_y + bar_height + tick;
  float free_from = x0;
  for (const double number : scale.numbers()) {
    const double u = (number - scale.low) / (scale.high - scale.low);
    const float x = std::floor(bar_x + inner * float(u));
    draw.box(x, bar_y + bar_height, x + unit, numbers_y, legend_letters);
    const std::string words = fmt::format("{:.6g}", number);
    const float w = text_width(words, draw.font(), text), left = std::floor(x - 0.5f * w);
    if (left < free_from) continue;
    draw.text(words, left, numbers_y, text, legend_letters);
    free_from = left + w + 5 * unit;
  }
  return tall;
}

}  // namespace

void add_legends(const std::vector<ColourLegend>& legends, const FontAtlas& font,
                 const std::array<float, 4>& area, int height, float ui_scale, UiDrawList& ui) {
  FlatDraw draw(ui, font);
  // Whole multiples of the bitmap font's 13 pixels stay sharp.
  const float unit = std::max(1.0f, std::floor(float(height) / 480 / ui_scale)) * ui_scale;
  const float margin = 8 * unit;
  const float widest = 0.3f * (area[2] - area[0]);
  float bottom = area[3] - margin;
  for (const ColourLegend& legend : legends) {
    if (bottom - 60 * unit < area[1]) break;
    bottom -= add_legend(legend, area[2] - margin, bottom, unit, widest, draw) + margin;
  }
}

}  // namespace tumble
