#include "viewer/ui/shell.hpp"

#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

constexpr ImGuiWindowFlags fixed_window = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                          ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                          ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav;

void draw_panel(PanelContext& context, const UiLayout::Placed& placed) {
  const PanelEntry& panel = *placed.panel;
  const UiRect& r = placed.rect;
  ImGui::SetNextWindowPos(ImVec2(r.x, r.y));
  ImGui::SetNextWindowSize(ImVec2(r.width, r.height));
  if (panel.dock == Dock::centre) ImGui::SetNextWindowFocus();
  const std::string id = fmt::format("##panel.{}", panel.name);
  // A first frame of unknown height would show a scrollbar for an instant.
  const bool measured = context.state.content_height[size_t(panel.id)] > 0;
  ImGui::Begin(id.c_str(), nullptr, fixed_window | (measured ? 0 : ImGuiWindowFlags_NoScrollbar));
  if (panel_heading(context, panel)) context.state.shows(panel.id) = false;
  panel.draw(context);
  ImGui::Dummy(ImVec2(0, 0));  // closes the last line, whatever its spacing was
  const float end =
      ImGui::GetCursorPosY() - ImGui::GetStyle().ItemSpacing.y + ImGui::GetStyle().WindowPadding.y;
  context.state.content_height[size_t(panel.id)] = std::ceil(end);
  context.host.mark(fmt::format("panel.{}", panel.name), r);
  ImGui::End();
}

void dim_scene(PanelContext& context, double width, double height) {
  // Behind a centred panel: a click there closes it.
  ImGui::SetNextWindowPos(ImVec2(0, 0));
  ImGui::SetNextWindowSize(ImVec2(float(width), float(height)));
  ImGui::PushStyleColor(ImGuiCol_WindowBg, palette::rgba(0x06080A, 0.45f));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
  ImGui::Begin("##dim", nullptr, fixed_window | ImGuiWindowFlags_NoFocusOnAppearing);
  if (ImGui::IsWindowHovered() && ImGui::IsMouseClicked(0)) {
    context.state.shows(PanelId::help) = false;
    context.state.shows(PanelId::scenes) = false;
  }
  ImGui::End();
  ImGui::PopStyleVar(2);
  ImGui::PopStyleColor();
}

}  // namespace

UiRect draw_ui(PanelContext& context, double width, double height) {
  if (context.state.hidden) {
    const UiRect whole{0, 0, float(width), float(height)};
    draw_toasts(context, whole);
    return whole;
  }
  const UiLayout layout = layout_ui(width, height, context.state);
  draw_top_bar(context, layout.top_bar);
  bool centred = false;
  for (const UiLayout::Placed& placed : layout.panels)
    if (placed.panel->dock != Dock::centre)
      draw_panel(context, placed);
    else
      centred = true;
  if (centred) {
    dim_scene(context, width, height);
    for (const UiLayout::Placed& placed : layout.panels)
      if (placed.panel->dock == Dock::centre) draw_panel(context, placed);
  }
  draw_toasts(context, layout.free_area);
  return layout.free_area;
}

}  // namespace tumble
