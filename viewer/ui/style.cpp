#include "viewer/ui/style.hpp"

#include <imgui.h>

namespace tumble {
namespace {

ImVec4 colour(uint32_t c) {
  return ImGui::ColorConvertU32ToFloat4(c);
}

void apply_colours(ImVec4* c) {
  using namespace palette;
  c[ImGuiCol_Text] = colour(text);
  c[ImGuiCol_TextDisabled] = colour(faint);
  c[ImGuiCol_WindowBg] = colour(panel);
  c[ImGuiCol_ChildBg] = ImVec4(0, 0, 0, 0);
  c[ImGuiCol_PopupBg] = colour(rgba(0x1B1F25, 0.98f));
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
  c[ImGuiCol_SliderGrab] = colour(accent);
  c[ImGuiCol_SliderGrabActive] = colour(rgba(0xFFB875));
  c[ImGuiCol_ScrollbarBg] = ImVec4(0, 0, 0, 0);
  c[ImGuiCol_ScrollbarGrab] = colour(hover);
  c[ImGuiCol_ScrollbarGrabHovered] = colour(pressed);
  c[ImGuiCol_ScrollbarGrabActive] = colour(pressed);
  c[ImGuiCol_TextSelectedBg] = colour(rgba(0xF39A4A, 0.35f));
  c[ImGuiCol_NavHighlight] = ImVec4(0, 0, 0, 0);
  c[ImGuiCol_ModalWindowDimBg] = ImVec4(0.02f, 0.03f, 0.04f, 0.55f);
}

}  // namespace

void apply_ui_style() {
  ImGui::StyleColorsDark();
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
  s.AntiAliasedLinesUseTex = false;  // the atlas is redrawn by our own device
  apply_colours(s.Colors);
}

}  // namespace tumble
