#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

uint32_t colour_of(ToastKind kind) {
  switch (kind) {
    case ToastKind::info:
      return palette::green;
    case ToastKind::warning:
      return palette::yellow;
    case ToastKind::error:
      return palette::red;
  }
  return palette::text;
}

/// Clicks pass through a message to what is below it, except on its close button, which is a window
/// of its own.
bool draw_cross(PanelContext& context, size_t index, const UiRect& message) {
  constexpr float size = 20, from_side = 16, from_top = 9;
  ImGui::SetNextWindowPos(
      ImVec2(message.x + message.width - size - from_side, message.y + from_top));
  ImGui::SetNextWindowSize(ImVec2(size, size));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
  const std::string name = fmt::format("toast{}.close", index);
  ImGui::Begin(("##" + name).c_str(), nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                   ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBackground);
  const bool closed = icon_button(context, name, Icon::close, "close", "Esc", size);
  ImGui::End();
  ImGui::PopStyleVar(3);
  return closed;
}

/// Draws one message with its lower edge at `bottom`; returns its height.
float draw_toast(PanelContext& context, Toast& toast, size_t index, const UiRect& area,
                 float bottom, bool& closed) {
  const bool error = toast.kind == ToastKind::error;
  const float width = std::min(error ? 620.0f : 420.0f, area.width - 20);
  ImGui::SetNextWindowPos(ImVec2(area.x + 0.5f * area.width, bottom), ImGuiCond_Always,
                          ImVec2(0.5f, 1.0f));
  ImGui::SetNextWindowSizeConstraints(ImVec2(error ? width : 0, 0),
                                      ImVec2(width, 0.5f * area.height));
  const float alpha = error ? 1.0f : float(std::clamp(toast.seconds_left / 0.4, 0.0, 1.0));
  ImGui::PushStyleVar(ImGuiStyleVar_Alpha, std::max(alpha, 0.02f));
  ImGuiWindowFlags flags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                           ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                           ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav |
                           ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs;
  // Opaque, so that panels below do not show through.
  ImGui::PushStyleColor(ImGuiCol_WindowBg, palette::page);
  ImGui::Begin(fmt::format("##toast{}", index).c_str(), nullptr, flags);
  ImGui::PopStyleColor();
  const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRectFullScreen();
  list.AddRectFilled({at.x + 5, at.y + 11}, {at.x + 8, at.y + size.y - 11}, colour_of(toast.kind),
                     2);
  list.PopClipRect();
  ImGui::PushFont(context.host.fonts().strong);
  ImGui::PushTextWrapPos(error ? width - 50 : width - 28);
  ImGui::TextUnformatted(toast.title.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopFont();
  ImGui::PushTextWrapPos(width - 28);
  for (const std::string& line : toast.lines) note(line);
  ImGui::PopTextWrapPos();
  context.host.mark(fmt::format("toast{}", index), {at.x, at.y, size.x, size.y});
  ImGui::End();
  ImGui::PopStyleVar();
  if (error && draw_cross(context, index, {at.x, at.y, size.x, size.y})) closed = true;
  return size.y;
}

constexpr ImGuiWindowFlags notice_flags =
    ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
    ImGuiWindowFlags_AlwaysAutoResize;

/// Text for a slow tick, or for a seek over many ticks, which is not a hang.
std::string words_of_slow_tick(const UiModel& m) {
  const double seconds = std::floor(m.under_way_seconds);
  if (m.searching)
    return fmt::format("Looking for the next event: {:.0f} s, now at tick {}", seconds,
                       m.next_tick);
  if (m.way_to >= m.next_tick)
    return fmt::format("Computing up to tick {}: {:.0f} s, {} ticks to go", m.way_to, seconds,
                       m.way_to - m.next_tick + 1);
  if (m.way_to > 0) return fmt::format("Going back to tick {}: {:.0f} s", m.way_to, seconds);
  return fmt::format("Tick {} is under way: {:.0f} s", m.next_tick, seconds);
}

/// Message for a slow tick or a long seek, with a button to cancel it. Returns the y of its lower
/// edge.
float draw_slow_tick(PanelContext& context, const UiRect& area) {
  const UiModel& m = context.model;
  const float top = area.y + 14;
  if (m.under_way_seconds < slow_tick_seconds) return top;
  ImGui::SetNextWindowPos(ImVec2(area.x + 0.5f * area.width, top), ImGuiCond_Always,
                          ImVec2(0.5f, 0.0f));
  ImGui::Begin("##slow_tick", nullptr, notice_flags);
  ImGui::PushFont(context.host.fonts().strong);
  ImGui::TextUnformatted(words_of_slow_tick(m).c_str());
  ImGui::PopFont();
  ImGui::SameLine(0, 18);
  if (word_button(context, "slow_tick.cancel", "Cancel it", true,
                  "back to the last whole tick, and pause", shortcut_of(Action::close)))
    context.ask(CancelTick{});
  note("Everything else waits for it; R and another scene do not.");
  const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
  context.host.mark("slow_tick", {at.x, at.y, size.x, size.y});
  ImGui::End();
  return top + size.y + 8;
}

/// Message for a slow query of the world, with a button to cancel it. Returns the y of its lower
/// edge.
float draw_slow_question(PanelContext& context, const UiRect& area, float top) {
  const UiModel& m = context.model;
  if (m.asking.empty() || m.asking_seconds < slow_question_seconds) return top;
  ImGui::SetNextWindowPos(ImVec2(area.x + 0.5f * area.width, top), ImGuiCond_Always,
                          ImVec2(0.5f, 0.0f));
  ImGui::Begin("##slow_question", nullptr, notice_flags);
  ImGui::PushFont(context.host.fonts().strong);
  ImGui::TextUnformatted(
      fmt::format("Asking the world: {} ... {:.0f} s", m.asking, std::floor(m.asking_seconds))
          .c_str());
  ImGui::PopFont();
  ImGui::SameLine(0, 18);
  if (word_button(context, "slow_question.cancel", "Stop", true,
                  "the question is given up; the world stays as it is", shortcut_of(Action::close)))
    context.ask(CancelQuestion{});
  note(fmt::format("{} stops it. The world goes on afterwards as if nobody had asked.",
                   shortcut_of(Action::close)));
  const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
  context.host.mark("slow_question", {at.x, at.y, size.x, size.y});
  ImGui::End();
  return top + size.y + 8;
}

/// Message that a scene is being opened; the duration is unknown, so the bar only moves.
void draw_opening(PanelContext& context, const UiRect& area, float top) {
  constexpr double soon = 0.2;  // [s] no message for what opens faster
  const UiModel& m = context.model;
  if (m.opening.empty() || m.opening_seconds < soon) return;
  ImGui::SetNextWindowPos(ImVec2(area.x + 0.5f * area.width, top), ImGuiCond_Always,
                          ImVec2(0.5f, 0.0f));
  ImGui::Begin("##opening", nullptr, notice_flags | ImGuiWindowFlags_NoInputs);
  ImGui::PushFont(context.host.fonts().strong);
  ImGui::TextUnformatted(fmt::format("Opening {}", m.opening).c_str());
  ImGui::PopFont();
  note(fmt::format("{:.1f} s", m.opening_seconds));
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = std::max(ImGui::GetWindowContentRegionMax().x, 220.0f) - 14, part = 0.3f;
  ImGui::Dummy(ImVec2(width, 4));
  const double phase = std::fmod(m.opening_seconds / 1.4, 1.0);
  const auto from = float(phase * (1 + part) - part);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, {at.x + width, at.y + 3}, palette::raised, 2);
  list.AddRectFilled({at.x + width * std::max(from, 0.0f), at.y},
                     {at.x + width * std::min(from + part, 1.0f), at.y + 3}, palette::accent, 2);
  const ImVec2 place = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
  context.host.mark("opening", {place.x, place.y, size.x, size.y});
  ImGui::End();
}

}  // namespace

void draw_toasts(PanelContext& context, const UiRect& area) {
  draw_opening(context, area, draw_slow_question(context, area, draw_slow_tick(context, area)));
  auto& toasts = context.state.toasts;
  float bottom = area.y + area.height - 14;
  for (size_t i = toasts.size(); i-- > 0;) {
    Toast& toast = toasts[i];
    if (toast.kind != ToastKind::error) toast.seconds_left -= context.dt;
    bool closed = toast.seconds_left <= 0;
    if (!closed) bottom -= draw_toast(context, toast, i, area, bottom, closed) + 8;
    if (closed) toasts.erase(toasts.begin() + std::ptrdiff_t(i));
  }
}

}  // namespace tumble
