#include "viewer/ui/shell.hpp"

#include "viewer/interact/picking.hpp"
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
constexpr ImGuiWindowFlags still_window =
    ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;

/// Draws the contents of a panel, which scroll below its fixed heading.
void draw_contents(PanelContext& context, const PanelEntry& panel, const UiRect& r) {
  float& height = context.state.content_height[size_t(panel.id)];
  // In the first frame the height is unknown, and a scrollbar would flash.
  const bool measured = height > 0;
  const float top = ImGui::GetCursorPosY();
  const ImVec2 padding = ImGui::GetStyle().WindowPadding;
  ImGui::SetCursorPosX(0);
  // The scrollbar is at the edge of the panel, where the window's padding would clip it; the
  // contents keep the padding.
  ImGui::PushClipRect({r.x, r.y}, {r.x + r.width, r.y + r.height}, false);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(padding.x, 0));
  float* const footer = ImGui::GetStateStorage()->GetFloatRef(ImGui::GetID("footer"), 0);
  const float foot = panel.footer ? *footer : 0;
  ImGui::BeginChild("##contents", ImVec2(r.width, std::max(r.height - top - foot, 1.0f)), false,
                    ImGuiWindowFlags_AlwaysUseWindowPadding | ImGuiWindowFlags_NoNav |
                        (measured ? 0 : still_window));
  ImGui::PopStyleVar();
  panel.draw(context);
  const float spacing = ImGui::GetStyle().ItemSpacing.y;
  ImGui::Dummy(ImVec2(0, 0));  // ends the last line, whatever its spacing
  ImGui::Dummy(ImVec2(0, std::max(padding.y - spacing, 0.0f)));
  const float end = ImGui::GetCursorPosY() - spacing;
  height = std::ceil(top + end + foot);
  ImGui::EndChild();
  ImGui::PopClipRect();
  if (!panel.footer) return;
  constexpr float gap = 6;
  if (height > r.height) {  // the contents continue below the edge
    const float y = r.y + r.height - foot;
    ImGui::GetWindowDrawList()->AddLine({r.x, y}, {r.x + r.width, y},
                                        ImGui::GetColorU32(ImGuiCol_Separator));
  }
  ImGui::SetCursorPos(ImVec2(padding.x, r.height - foot + gap));
  ImGui::BeginGroup();
  panel.footer(context);
  ImGui::EndGroup();
  *footer = gap + ImGui::GetItemRectSize().y + padding.y;
}

void draw_panel(PanelContext& context, const UiLayout::Placed& placed) {
  const PanelEntry& panel = *placed.panel;
  const UiRect& r = placed.rect;
  ImGui::SetNextWindowPos(ImVec2(r.x, r.y));
  ImGui::SetNextWindowSize(ImVec2(r.width, r.height));
  const bool centred = panel.dock == Dock::centre;
  if (centred) ImGui::SetNextWindowFocus();
  const std::string id = fmt::format("##panel.{}", panel.name);
  // A clicked panel must not cover messages, nor the dimming of a centred panel.
  const ImGuiWindowFlags level = centred ? 0 : ImGuiWindowFlags_NoBringToFrontOnFocus;
  // Opaque, so that panels below a page of text do not show through.
  if (centred) ImGui::PushStyleColor(ImGuiCol_WindowBg, palette::page);
  ImGui::Begin(id.c_str(), nullptr, fixed_window | level | still_window);
  if (centred) ImGui::PopStyleColor();
  context.host.mark(fmt::format("panel.{}", panel.name), r);
  if (panel_heading(context, panel)) context.state.shows(panel.id) = false;
  if (placed.folded) {
    if (ImGui::IsWindowHovered() && ImGui::IsMouseClicked(0)) context.state.raise(panel.id);
    return ImGui::End();
  }
  draw_contents(context, panel, r);
  ImGui::End();
}

void dim_scene(PanelContext& context, double width, double height) {
  // Full-size window behind a centred panel: a click on it closes the panel.
  ImGui::SetNextWindowPos(ImVec2(0, 0));
  ImGui::SetNextWindowSize(ImVec2(float(width), float(height)));
  ImGui::PushStyleColor(ImGuiCol_WindowBg, palette::rgba(0x06080A, 0.45f));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
  ImGui::Begin("##dim", nullptr, fixed_window | ImGuiWindowFlags_NoFocusOnAppearing);
  if (ImGui::IsWindowHovered() && ImGui::IsMouseClicked(0)) {
    context.state.shows(PanelId::help) = false;
    context.state.shows(PanelId::scenes) = false;
    context.state.shows(PanelId::save) = false;
  }
  ImGui::End();
  ImGui::PopStyleVar(2);
  ImGui::PopStyleColor();
}

void draw_selection_box(const UiRect& box) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const ImVec2 from(box.x, box.y), to(box.x + box.width, box.y + box.height);
  list.AddRectFilled(from, to, palette::accent_soft);
  list.AddRect(from, to, palette::accent);
}

}  // namespace

UiRect draw_ui(PanelContext& context, double width, double height) {
  if (context.model.selection_box) draw_selection_box(*context.model.selection_box);
  if (context.state.hidden) {
    const UiRect whole{0, 0, float(width), float(height)};
    draw_toasts(context, whole);
    return whole;
  }
  context.state.raise_new();
  context.state.idle[size_t(PanelId::inspector)] =
      !find_slot(*context.model.frame, context.model.selected);
  context.state.beside =
      context.model.comparison && context.state.compared_as == ComparedAs::beside;
  const UiLayout layout = layout_ui(width, height, context.state);
  draw_top_bar(context, layout.top_bar);
  const UiRect free_area = draw_timeline(context, layout.free_area);
  draw_legend(context, free_area);
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
  // Messages may cover panels, rather than be too narrow.
  constexpr float least_room = 260;
  UiRect room = free_area;
  if (room.width < least_room) room = {0, room.y, float(width), room.height};
  draw_toasts(context, room);
  return free_area;
}

}  // namespace tumble
