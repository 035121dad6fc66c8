#pragma once
#include <cstdint>

namespace tumble {

/// Colours of the panels as ImGui takes them (sRGB, 0xAABBGGRR made by these).
namespace palette {
constexpr uint32_t rgba(uint32_t rgb, float alpha = 1) {
  return uint32_t(alpha * 255 + 0.5f) << 24 | (rgb & 0xff) << 16 | (rgb & 0xff00) |
         (rgb >> 16 & 0xff);
}
constexpr uint32_t panel = rgba(0x15181D, 0.93f);
constexpr uint32_t page = rgba(0x15181D, 0.985f);
constexpr uint32_t raised = rgba(0x262B33);
constexpr uint32_t hover = rgba(0x323943);
constexpr uint32_t pressed = rgba(0x3D4652);
constexpr uint32_t line = rgba(0xFFFFFF, 0.08f);
constexpr uint32_t text = rgba(0xE9ECEF);
constexpr uint32_t dim = rgba(0x9DA5AF);
constexpr uint32_t faint = rgba(0x69717C);
constexpr uint32_t accent = rgba(0xF39A4A);
constexpr uint32_t accent_soft = rgba(0xF39A4A, 0.22f);
constexpr uint32_t green = rgba(0x6FCF97);
constexpr uint32_t blue = rgba(0x64B1F2);
constexpr uint32_t violet = rgba(0xB690F0);
constexpr uint32_t red = rgba(0xF0685A);
constexpr uint32_t yellow = rgba(0xF2CF63);
/// Distinct colours of bars and curves, in order.
constexpr uint32_t series[] = {blue,           accent,        green,          violet,
                               yellow,         red,           rgba(0x5FD3CF), rgba(0xE58AC0),
                               rgba(0xA3B86C), rgba(0x8C9BB0)};
constexpr int series_count = int(sizeof(series) / sizeof(series[0]));
}  // namespace palette

/// Spacing, rounding and colours of every panel, for the current ImGui context. All sizes are in
/// UI units: the host scales by the atlas, not the style.
void apply_ui_style();

}  // namespace tumble
