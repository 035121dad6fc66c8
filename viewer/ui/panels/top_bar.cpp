#include "viewer/ui/bar_plan.hpp"
#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

std::string speed_text(double speed) {
  if (speed >= 0.999) return fmt::format("{:.3g}×", speed);
  return fmt::format("1/{:.3g}×", 1 / speed);
}

/// Text vertically centred in the bar, beside buttons of 30 UI units.
void bar_text(const std::string& text, uint32_t colour) {
  const float y = ImGui::GetCursorPosY();
  // ImGui already lowers text beside a button by the frame's padding.
  ImGui::SetCursorPosY(y + 0.5f * (30 - ImGui::GetTextLineHeight()) -
                       ImGui::GetStyle().FramePadding.y);
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopStyleColor();
}

const std::string& title_of(const UiModel& m) {
  return m.scene_title.empty() ? m.scene_name : m.scene_title;
}
constexpr float around_title = 46;

float scene_button_width(PanelContext& context) {
  ImGui::PushFont(context.host.fonts().strong);
  const float width = ImGui::CalcTextSize(title_of(context.model).c_str()).x + around_title;
  ImGui::PopFont();
  return width;
}

void draw_scene_button(PanelContext& context, float width) {
  const std::string& title = title_of(context.model);
  ImGui::PushFont(context.host.fonts().strong);
  const std::string text = shortened(title, width - around_title + 6);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  if (ImGui::Button("##scene", ImVec2(width, 30))) context.ask(Action::pick_scene);
  context.host.mark("bar.scene");
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float y = at.y + 0.5f * (30 - ImGui::GetTextLineHeight());
  list.AddText({at.x + 12, y}, palette::text, text.c_str());
  const ImVec2 c(at.x + width - 16, at.y + 16);
  list.AddTriangleFilled({c.x - 4, c.y - 2.5f}, {c.x + 4, c.y - 2.5f}, {c.x, c.y + 2.5f},
                         palette::dim);
  ImGui::PopFont();
  tooltip_with_key(context, text == title ? "open another scene" : title,
                   shortcut_of(Action::pick_scene));
}

/// Draws the buttons for time, as many as fit.
void draw_transport(PanelContext& context, const BarPlan& plan) {
  const auto button = [&](const char* name, Icon icon, const char* doc, Action action,
                          bool lit = false) {
    if (icon_button(context, name, icon, doc, shortcut_of(action), 30, lit)) context.ask(action);
    ImGui::SameLine(0, 2);
  };
  if (plan.steps) {
    button("transport.restart", Icon::restart, "restart", Action::restart);
    button("transport.back", Icon::step_back, "one tick back (Shift: ten)", Action::step_back);
  }
  button("transport.pause", context.model.paused ? Icon::play : Icon::pause,
         context.model.paused ? "go on" : "pause", Action::toggle_pause, context.model.paused);
  if (plan.steps)
    button("transport.forward", Icon::step_forward, "one tick forward (Shift: ten)",
           Action::step_forward);
  if (!plan.speed) return;
  ImGui::SameLine(0, 10);
  if (word_button(context, "transport.slower", "–", false, "half the speed",
                  shortcut_of(Action::slower)))
    context.ask(Action::slower);
  ImGui::SameLine(0, 0);
  const std::string speed = speed_text(context.model.speed);
  ImGui::PushFont(context.host.fonts().strong);
  const float cell = 46, text_width = ImGui::CalcTextSize(speed.c_str()).x;
  const float x = ImGui::GetCursorPosX(), y = ImGui::GetCursorPosY();
  ImGui::SetCursorPosX(x + 0.5f * (cell - text_width));
  bar_text(speed, palette::text);
  ImGui::PopFont();
  ImGui::SameLine(x + cell, 0);
  ImGui::SetCursorPosY(y);
  if (word_button(context, "transport.faster", "+", false, "twice the speed",
                  shortcut_of(Action::faster)))
    context.ask(Action::faster);
}

/// Draws state, time and tick, the most important first, as far as they end before `right`.
void draw_clock(PanelContext& context, float right) {
  const UiModel& m = context.model;
  const float y = ImGui::GetCursorPosY();
  float left = ImGui::GetCursorPosX();
  const auto put = [&](const std::string& text, uint32_t colour) {
    const float width = ImGui::CalcTextSize(text.c_str()).x;
    if (left + width > right) return false;
    ImGui::SetCursorPos(ImVec2(left, y + ImGui::GetStyle().FramePadding.y));
    bar_text(text, colour);
    left += width + 10;
    return true;
  };
  if (m.recording && put(fmt::format("rec {}", m.recorded_frames), palette::red))
    tooltip_with_key(context, "writing a frame sequence", shortcut_of(Action::toggle_sequence));
  if (m.behind && !m.paused && put("slow", palette::yellow))
    tooltip_with_key(context, "a step takes longer than its tick: real time is dropped, not ticks",
                     {});
  if (put(fmt::format("{:.2f} s", m.frame->time), palette::text))
    put(fmt::format("tick {}", m.frame->tick), palette::faint);
}

struct Switch {
  PanelId id;
  const char* text;
  const char* doc;
};
constexpr Switch switches[] = {
    {PanelId::lesson, "Lesson", "what this scene teaches, page by page"},
    {PanelId::statistics, "Stats", "statistics and stage profile"},
    {PanelId::energy, "Energy", "energy plot"},
    {PanelId::measure, "Plot", "curves of what bodies and joints do"},
    {PanelId::compare, "Compare", "a second world with other settings"},
    {PanelId::bookmarks, "Time", "bookmarks, loop, camera flight, recording"},
    {PanelId::events, "Events", "list of impacts and of what else happens"},
    {PanelId::build, "Build", "new bodies, joints and springs"},
    {PanelId::drawing, "Show", "what is drawn over the scene"},
    {PanelId::inspector, "Body", "the selected body"},
    {PanelId::settings, "Settings", "tick, gravity, algorithms"},
    {PanelId::help, "Help", "keys and mouse"},
};

constexpr const char* menu_text = "Panels";

float word_width(const char* text) {
  return ImGui::CalcTextSize(text).x + 2 * ImGui::GetStyle().FramePadding.x;
}
/// Only scenes with a lesson have a switch for it.
bool has(const PanelContext& context, const Switch& s) {
  return s.id != PanelId::lesson || context.model.lesson;
}
float switches_width(const PanelContext& context) {
  float width = 0;
  for (const Switch& s : switches)
    if (has(context, s)) width += word_width(s.text) + 2;
  return width;
}

std::string panel_shortcut(PanelId id) {
  for (const PanelEntry& panel : all_panels())
    if (panel.id == id && panel.toggle) return shortcut_of(*panel.toggle);
  return {};
}
std::string mark_of(PanelId id) {
  return fmt::format("bar.{}", all_panels()[size_t(id)].name);
}

void draw_switches(PanelContext& context) {
  for (const Switch& s : switches) {
    if (!has(context, s)) continue;
    bool& shown = context.state.shows(s.id);
    if (word_button(context, mark_of(s.id), s.text, shown, s.doc, panel_shortcut(s.id)))
      shown = !shown;
    ImGui::SameLine(0, 2);
  }
}

/// Draws the same switches as a menu.
void draw_menu(PanelContext& context) {
  const bool open = ImGui::IsPopupOpen("##menu");
  if (word_button(context, "bar.menu", menu_text, open, "what is shown", {}))
    ImGui::OpenPopup("##menu");
  const ImVec2 below(ImGui::GetItemRectMax().x, ImGui::GetItemRectMax().y + 6);
  ImGui::SetNextWindowPos(below, ImGuiCond_Always, ImVec2(1, 0));
  if (!ImGui::BeginPopup("##menu")) return;
  for (const Switch& s : switches) {
    if (!has(context, s)) continue;
    bool& shown = context.state.shows(s.id);
    if (ImGui::MenuItem(s.text, panel_shortcut(s.id).c_str(), shown)) shown = !shown;
    context.host.mark(mark_of(s.id));
  }
  ImGui::EndPopup();
}

}  // namespace

void draw_top_bar(PanelContext& context, const UiRect& rect) {
  ImGui::SetNextWindowPos(ImVec2(rect.x, rect.y));
  ImGui::SetNextWindowSize(ImVec2(rect.width, rect.height));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(10, 8));
  // With two pictures, the line shows where each of them ends.
  const bool beside = context.model.comparison && context.state.compared_as == ComparedAs::beside;
  ImGui::SetNextWindowBgAlpha(beside ? 1.0f : ImGui::GetStyleColorVec4(ImGuiCol_WindowBg).w);
  ImGui::Begin("##bar", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoScrollbar |
                   ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoNav |
                   ImGuiWindowFlags_NoBringToFrontOnFocus);
  ImGui::PopStyleVar(3);
  const BarPlan plan = plan_bar(
      rect.width, {scene_button_width(context), switches_width(context), word_width(menu_text)});
  const float y = ImGui::GetCursorPosY();
  ImGui::SetCursorPosX(plan.scene_x);
  draw_scene_button(context, plan.scene_width);
  ImGui::SetCursorPos(ImVec2(plan.transport_x, y));
  draw_transport(context, plan);
  ImGui::SetCursorPos(ImVec2(plan.transport_end + 16, y));
  draw_clock(context, plan.right_x - 10);
  ImGui::SetCursorPos(ImVec2(plan.right_x, y));
  plan.switches ? draw_switches(context) : draw_menu(context);
  context.host.mark("panel.bar", rect);
  ImGui::End();
}

}  // namespace tumble
