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

/// Text in the middle of the bar's height, beside buttons of 30 units.
void bar_text(const std::string& text, uint32_t colour) {
  const float y = ImGui::GetCursorPosY();
  // ImGui lowers text beside a button by the frame's padding by itself.
  ImGui::SetCursorPosY(y + 0.5f * (30 - ImGui::GetTextLineHeight()) -
                       ImGui::GetStyle().FramePadding.y);
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopStyleColor();
}
/// Goes on at the right of bar_text, at the height of buttons.
void after_bar_text(float spacing, float y) {
  ImGui::SameLine(0, spacing);
  ImGui::SetCursorPosY(y);
}

void draw_scene_button(PanelContext& context, float widest) {
  const UiModel& m = context.model;
  const std::string& title = m.scene_title.empty() ? m.scene_name : m.scene_title;
  ImGui::PushFont(context.host.fonts().strong);
  const float width = std::min(ImGui::CalcTextSize(title.c_str()).x + 46, widest);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  if (ImGui::Button("##scene", ImVec2(width, 30))) context.ask(Action::pick_scene);
  context.host.mark("bar.scene");
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float y = at.y + 0.5f * (30 - ImGui::GetTextLineHeight());
  const ImVec4 clip(at.x, at.y, at.x + width - 26, at.y + 30);
  list.AddText(ImGui::GetFont(), ImGui::GetFontSize(), {at.x + 12, y}, palette::text, title.c_str(),
               nullptr, 0, &clip);
  const ImVec2 c(at.x + width - 16, at.y + 16);
  list.AddTriangleFilled({c.x - 4, c.y - 2.5f}, {c.x + 4, c.y - 2.5f}, {c.x, c.y + 2.5f},
                         palette::dim);
  ImGui::PopFont();
  tooltip_with_key(context, "open another scene", shortcut_of(Action::pick_scene));
}

/// Buttons of time; the speed too where there is room.
void draw_transport(PanelContext& context, bool with_speed) {
  const auto button = [&](const char* name, Icon icon, const char* doc, Action action,
                          bool lit = false) {
    if (icon_button(context, name, icon, doc, shortcut_of(action), 30, lit)) context.ask(action);
    ImGui::SameLine(0, 2);
  };
  button("transport.restart", Icon::restart, "restart", Action::restart);
  button("transport.back", Icon::step_back, "one tick back (Shift: ten)", Action::step_back);
  button("transport.pause", context.model.paused ? Icon::play : Icon::pause,
         context.model.paused ? "go on" : "pause", Action::toggle_pause, context.model.paused);
  button("transport.forward", Icon::step_forward, "one tick forward (Shift: ten)",
         Action::step_forward);
  if (!with_speed) return;
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

/// Time, tick and state as far as they end before `right`.
void draw_clock(PanelContext& context, float right) {
  const Frame& frame = *context.model.frame;
  const float y = ImGui::GetCursorPosY();
  const std::string time = fmt::format("{:.2f} s", frame.time);
  const std::string tick = fmt::format("tick {}", frame.tick);
  const float left = ImGui::GetCursorPosX(), width = ImGui::CalcTextSize(time.c_str()).x;
  if (left + width > right) return;
  bar_text(time, palette::text);
  if (left + width + 10 + ImGui::CalcTextSize(tick.c_str()).x > right) return;
  after_bar_text(10, y);
  bar_text(tick, palette::faint);
  if (context.model.behind && !context.model.paused) {
    after_bar_text(10, y);
    bar_text("slow", palette::yellow);
    tooltip_with_key(context, "a step takes longer than its tick: real time is dropped, not ticks",
                     {});
  }
  if (context.model.recording) {
    after_bar_text(10, y);
    bar_text(fmt::format("rec {}", context.model.recorded_frames), palette::red);
    tooltip_with_key(context, "writing a frame sequence", shortcut_of(Action::toggle_sequence));
  }
}

struct Switch {
  PanelId id;
  const char* text;
  const char* doc;
};
constexpr Switch switches[] = {
    {PanelId::statistics, "Stats", "statistics and stage profile"},
    {PanelId::energy, "Energy", "energy plot"},
    {PanelId::drawing, "Show", "what is drawn over the scene"},
    {PanelId::inspector, "Body", "the selected body"},
    {PanelId::settings, "Settings", "tick, gravity, algorithms"},
    {PanelId::help, "Help", "keys and mouse"},
};

float switches_width() {
  float width = 0;
  for (const Switch& s : switches)
    width += ImGui::CalcTextSize(s.text).x + 2 * ImGui::GetStyle().FramePadding.x + 2;
  return width;
}

void draw_switches(PanelContext& context) {
  for (const Switch& s : switches) {
    std::string shortcut;
    for (const PanelEntry& panel : all_panels())
      if (panel.id == s.id && panel.toggle) shortcut = shortcut_of(*panel.toggle);
    const std::string name = fmt::format("bar.{}", all_panels()[size_t(s.id)].name);
    bool& shown = context.state.shows(s.id);
    if (word_button(context, name, s.text, shown, s.doc, shortcut)) shown = !shown;
    ImGui::SameLine(0, 2);
  }
}

}  // namespace

void draw_top_bar(PanelContext& context, const UiRect& rect) {
  ImGui::SetNextWindowPos(ImVec2(rect.x, rect.y));
  ImGui::SetNextWindowSize(ImVec2(rect.width, rect.height));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(10, 8));
  ImGui::Begin("##bar", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoScrollbar |
                   ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoNav |
                   ImGuiWindowFlags_NoBringToFrontOnFocus);
  ImGui::PopStyleVar(3);
  // The transport stands in the middle where there is room, else after the scene's name.
  const float transport_width = 250, right = rect.width - switches_width() - 10;
  draw_scene_button(context, std::clamp(0.27f * right, 90.0f, 250.0f));
  const float after = ImGui::GetItemRectMax().x + 14;
  const float x = std::max(
      after, std::min(0.5f * (rect.width - transport_width) - 60, right - transport_width - 150));
  ImGui::SameLine(x);
  draw_transport(context, x + transport_width <= right);
  ImGui::SameLine(0, 16);
  draw_clock(context, right - 10);
  ImGui::SameLine(right);
  ImGui::SetCursorPosY(ImGui::GetCursorStartPos().y);
  draw_switches(context);
  context.host.mark("panel.bar", rect);
  ImGui::End();
}

}  // namespace tumble
