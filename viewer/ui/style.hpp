#pragma once
#include <array>
#include <cstdint>

namespace tumble {

/// Colours of the panels in ImGui's format (sRGB, 0xAABBGGRR; the functions below build them).
namespace palette {
constexpr uint32_t rgba(uint32_t rgb, float alpha = 1) {
  return uint32_t(alpha * 255 + 0.5f) << 24 | (rgb & 0xff) << 16 | (rgb & 0xff00) |
         (rgb >> 16 & 0xff);
}
constexpr uint32_t faded(uint32_t colour, float alpha) {
  return (colour & 0xffffff) | uint32_t(alpha * 255 + 0.5f) << 24;
}
/// Red, green and blue, 0..1.
constexpr std::array<float, 3> components(uint32_t colour) {
  return {float(colour & 0xff) / 255, float(colour >> 8 & 0xff) / 255,
          float(colour >> 16 & 0xff) / 255};
}
// Colours of the present theme; apply_ui_style() sets them.
inline uint32_t panel, page, popup, raised, hover, pressed;
inline uint32_t backdrop;  ///< of the window where there is no picture
inline uint32_t line;      ///< faint separator
inline uint32_t well;      ///< background of plots
inline uint32_t text, dim, faint, on_accent;
inline uint32_t accent, accent_soft, accent_strong;
inline uint32_t green, blue, violet, red, yellow;
/// Distinguishable colours for bars and curves, in order.
constexpr int series_count = 10;
inline uint32_t series[series_count];
}  // namespace palette

enum class Theme : uint8_t { dark, light };
constexpr const char* theme_names[] = {"dark", "light"};

/// Sets spacing, rounding and colours of all panels for the current ImGui context. All sizes are in
/// UI units: UiHost scales the font atlas and the output, not the style.
void apply_ui_style(Theme theme = Theme::dark);

}  // namespace tumble
