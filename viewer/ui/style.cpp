#include "viewer/ui/style.hpp"

#include <algorithm>
#include <iterator>

#include <imgui.h>

namespace tumble {
namespace {

ImVec4 colour(uint32_t c) {
  return ImGui::ColorConvertU32ToFloat4(c);
}

void set_dark() {
  using namespace palette;
  panel = rgba(0x15181D, 0.93f);
  page = rgba(0x15181D, 0.985f);
  backdrop = rgba(0x0C0E11);
  popup = rgba(0x1B1F25, 0.98f);
  raised = rgba(0x262B33);
  hover = rgba(0x323943);
  pressed = rgba(0x3D4652);
  line = rgba(0xFFFFFF, 0.08f);
  well = rgba(0x000000, 0.25f);
  on_accent = rgba(0x1D1510);
  text = rgba(0xE9ECEF);
  dim = rgba(0x9DA5AF);
  faint = rgba(0x69717C);
  accent = rgba(0xF39A4A);
  accent_soft = rgba(0xF39A4A, 0.22f);
  accent_strong = rgba(0xFFB875);
  green = rgba(0x6FCF97);
  blue = rgba(0x64B1F2);
  violet = rgba(0xB690F0);
  red = rgba(0xF0685A);
  yellow = rgba(0xF2CF63);
  const uint32_t all[] = {blue, accent,         green,          violet,         yellow,
                          red,  rgba(0x5FD3CF), rgba(0xE58AC0), rgba(0xA3B86C), rgba(0x8C9BB0)};
  std::copy(std::begin(all), std::end(all), series);
}

void set_light() {
  using namespace palette;
  panel = rgba(0xF8F8F6, 0.95f);
  page = rgba(0xF8F8F6, 0.99f);
  backdrop = rgba(0xD9DDE1);
  popup = rgba(0xFFFFFF, 0.99f);
  raised = rgba(0xE4E7EA);
  hover = rgba(0xD5DADF);
  pressed = rgba(0xC5CBD2);
  line = rgba(0x000000, 0.13f);
  well = rgba(0xFFFFFF, 0.75f);
  on_accent = rgba(0xFFFFFF);
  text = rgba(0x1B2025);
  dim = rgba(0x515A64);
  faint = rgba(0x7E8791);
  accent = rgba(0xA65100);
  accent_soft = rgba(0xE07A10, 0.22f);
  accent_strong = rgba(0x7C3D00);
  green = rgba(0x17803F);
  blue = rgba(0x1766B8);
  violet = rgba(0x7244C8);
  red = rgba(0xC22F20);
  yellow = rgba(0x765800);
  const uint32_t all[] = {blue, accent,         green,          violet,         yellow,
                          red,  rgba(0x0B7F7B), rgba(0xB13B80), rgba(0x5E7220), rgba(0x4C5A6E)};
  std::copy(std::begin(all), std::end(all), series);
}

void apply_colours(ImVec4* c) {
  using namespace palette;
  c[ImGuiCol_Text] = colour(text);
  c[ImGuiCol_TextDisabled] = colour(faint);
  c[ImGuiCol_WindowBg] = colour(panel);
  c[ImGuiCol_ChildBg] = ImVec4(0, 0, 0, 0);
  c[ImGuiCol_PopupBg] = colour(popup);
  c[ImGuiCol_Border] = colour(line);
  c[ImGuiCol_FrameBg] = colour(raised);
  c[ImGuiCol_FrameBgHovered] = colour(hover);
  c[ImGuiCol_FrameBgActive] = colour(pressed);
  c[ImGuiCol_Button] = colour(raised);
  c[ImGuiCol_ButtonHovered] = colour(hover);
  c[ImGuiCol_ButtonActive] = colour(pressed);
  c[ImGuiCol_Header] = colour(accent_soft);
  c[ImGuiCol_HeaderHovered] = colour(hover);
  c[ImGuiCol_HeaderActive] = colour(pressed);
  c[ImGuiCol_Separator] = colour(line);
  c[ImGuiCol_CheckMark] = colour(accent);
  // The number of a slider is written over its knob.
  c[ImGuiCol_SliderGrab] = colour(faded(accent, 0.35f));
  c[ImGuiCol_SliderGrabActive] = colour(faded(accent_strong, 0.28f));
  c[ImGuiCol_ScrollbarBg] = ImVec4(0, 0, 0, 0);
  c[ImGuiCol_ScrollbarGrab] = colour(hover);
  c[ImGuiCol_ScrollbarGrabHovered] = colour(pressed);
  c[ImGuiCol_ScrollbarGrabActive] = colour(pressed);
  c[ImGuiCol_TextSelectedBg] = colour(rgba(0xF39A4A, 0.35f));
  c[ImGuiCol_NavHighlight] = ImVec4(0, 0, 0, 0);
  c[ImGuiCol_ModalWindowDimBg] = ImVec4(0.02f, 0.03f, 0.04f, 0.55f);
}

}  // namespace

void apply_ui_style(Theme theme) {
  theme == Theme::light ? ImGui::StyleColorsLight() : ImGui::StyleColorsDark();
  theme == Theme::light ? set_light() : set_dark();
  ImGuiStyle& s = ImGui::GetStyle();
  s.WindowPadding = ImVec2(14, 12);
  s.FramePadding = ImVec2(9, 4);
  s.CellPadding = ImVec2(6, 3);
  s.ItemSpacing = ImVec2(8, 6);
  s.ItemInnerSpacing = ImVec2(7, 4);
  s.ScrollbarSize = 9;
  s.GrabMinSize = 9;
  s.WindowRounding = 9;
  s.PopupRounding = 8;
  s.FrameRounding = 5;
  s.GrabRounding = 5;
  s.ScrollbarRounding = 5;
  s.WindowBorderSize = 1;
  s.PopupBorderSize = 1;
  s.FrameBorderSize = 0;
  s.WindowMinSize = ImVec2(16, 16);
  s.DisabledAlpha = 0.4f;
  s.AntiAliasedLinesUseTex = false;  // our device uses an atlas of its own, without the baked lines
  apply_colours(s.Colors);
}

}  // namespace tumble
