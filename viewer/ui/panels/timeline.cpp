#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

constexpr float margin = 12, height = 40, widest = 760;

/// Maps ticks to positions on the time line.
struct Scale {
  float left = 0, right = 1;
  uint64_t first = 0, last = 1;

  float at(uint64_t tick) const {
    const double share = double(tick - std::min(tick, first)) / double(last - first);
    return left + float(std::min(share, 1.0)) * (right - left);
  }
  uint64_t tick(float x) const {
    const float share = std::clamp((x - left) / (right - left), 0.0f, 1.0f);
    return first + uint64_t(std::llround(double(share) * double(last - first)));
  }
};

/// Marks the ticks with events that pass the filter of the list.
void draw_events(PanelContext& context, const Scale& scale, float y) {
  if (!context.model.events) return;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  float last = scale.left - 2;
  size_t marks = 0;
  for (const WorldEvent& e : *context.model.events) {
    if (e.tick < scale.first || e.tick > scale.last) continue;
    if (!context.state.event_filter.takes(e)) continue;
    const float x = scale.at(e.tick);
    if (x < last + 1) continue;  // at most one mark per pixel
    list.AddRectFilled({x - 0.75f, y + 4}, {x + 0.75f, y + 12}, palette::yellow);
    last = x;
    ++marks;
  }
  context.host.mark(fmt::format("timeline.events.{}", marks));
}

/// Draws the bookmarks as flags above the line; those outside of its range are left out.
void draw_bookmarks(PanelContext& context, const Scale& scale, float y) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto& all = context.model.marks->bookmarks;
  for (size_t i = 0; i < all.size(); ++i) {
    if (all[i].tick < scale.first || all[i].tick > scale.last) continue;
    const float x = scale.at(all[i].tick);
    list.AddRectFilled({x - 0.75f, y - 15}, {x + 0.75f, y + 2}, palette::violet);
    list.AddTriangleFilled({x, y - 16}, {x, y - 7}, {x + 9, y - 11.5f}, palette::violet);
    context.host.mark(fmt::format("timeline.mark.{}", i), {x - 2, y - 14, 4, 12});
  }
}

void draw_span(const TickSpan& span, bool on, const Scale& scale, float y) {
  if (span.to < scale.first || span.from > scale.last) return;
  const float a = scale.at(span.from), b = scale.at(span.to);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const uint32_t colour = palette::faded(palette::green, on ? 0.9f : 0.45f);
  list.AddRectFilled({a, y - 6}, {b, y + 6}, palette::faded(palette::green, on ? 0.35f : 0.18f), 2);
  for (const float x : {a, b}) list.AddRectFilled({x - 1, y - 9}, {x + 1, y + 9}, colour);
}

/// The tick under the pointer, snapped to a bookmark nearby.
uint64_t tick_under(const PanelContext& context, const Scale& scale) {
  constexpr float reach = 5;
  const float x = ImGui::GetIO().MousePos.x;
  for (const Bookmark& b : context.model.marks->bookmarks)
    if (b.tick >= scale.first && b.tick <= scale.last && std::abs(scale.at(b.tick) - x) < reach)
      return b.tick;
  return scale.tick(x);
}

/// Shift + drag marks the span to be looped; true while that is going on.
bool draw_new_span(PanelContext& context, uint64_t under) {
  std::optional<uint64_t>& began = context.state.span_began;
  if (ImGui::IsItemActivated() && ImGui::GetIO().KeyShift) began = under;
  if (!ImGui::IsItemActive()) began.reset();
  if (!began) return false;
  const TickSpan span{std::min(*began, under), std::max(*began, under)};
  if (span.from < span.to && context.model.marks->span != span)
    context.ask(EditMarks{[span](TimeMarks& marks) { marks.span = span; }});
  return true;
}

/// Buttons at the ends of the line: a flag that sets a bookmark, a ring that loops.
bool sign_button(PanelContext& context, const char* name, ImVec2 at, bool flag, bool lit,
                 const char* doc, Action action) {
  ImGui::SetCursorScreenPos(at);
  const bool pressed = ImGui::InvisibleButton(name, ImVec2(24, 28));
  context.host.mark(name);
  const uint32_t colour = lit                      ? palette::accent
                          : ImGui::IsItemHovered() ? palette::text
                                                   : palette::dim;
  tooltip_with_key(context, doc, shortcut_of(action));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float x = at.x + 12, y = at.y + 14;
  if (flag) {
    list.AddRectFilled({x - 5, y - 8}, {x - 3.5f, y + 8}, colour);
    list.AddTriangleFilled({x - 4, y - 8}, {x - 4, y + 2}, {x + 7, y - 3}, colour);
  } else {
    list.PathArcTo({x, y}, 6, -0.6f, 4.6f, 24);
    list.PathStroke(colour, 0, 1.8f);
    list.AddTriangleFilled({x - 1, y - 10}, {x - 1, y - 2}, {x + 5, y - 6}, colour);
  }
  if (pressed) context.ask(action);
  return pressed;
}

void draw_line(PanelContext& context, const Scale& scale, float y) {
  const UiModel& m = context.model;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float now = scale.at(m.frame->tick);
  list.AddRectFilled({scale.left, y - 2}, {scale.right, y + 2}, palette::raised, 2);
  list.AddRectFilled({scale.left, y - 2}, {now, y + 2}, palette::accent, 2);
  if (m.marks->span) draw_span(*m.marks->span, m.marks->looping, scale, y);
  draw_events(context, scale, y);
  draw_bookmarks(context, scale, y);
  for (const uint64_t undo_step : m.undo_step_ticks)
    if (undo_step >= scale.first && undo_step <= scale.last)
      list.AddRectFilled({scale.at(undo_step) - 1.5f, y - 7}, {scale.at(undo_step) + 1.5f, y + 7},
                         palette::blue, 1);
  list.AddCircleFilled({now, y}, 7, palette::text);
}

}  // namespace

UiRect draw_timeline(PanelContext& context, const UiRect& free_area) {
  const UiModel& m = context.model;
  UiRect rest = free_area;
  const float width = std::min(widest, free_area.width - 2 * margin);
  const bool shown = m.paused || m.marks->looping;
  if (!shown || m.last_tick <= m.first_tick || width < 220) return rest;
  rest.height -= height + margin;
  const float x = free_area.x + 0.5f * (free_area.width - width);
  ImGui::SetNextWindowPos(ImVec2(x, rest.y + rest.height));
  ImGui::SetNextWindowSize(ImVec2(width, height));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(14, 6));
  ImGui::Begin("##timeline", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoScrollbar |
                   ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoNav |
                   ImGuiWindowFlags_NoBringToFrontOnFocus);
  ImGui::PopStyleVar();
  const std::string begin = fmt::format("{:.2f} s", m.clock->time_of(m.first_tick));
  const std::string end = fmt::format("{:.2f} s", m.clock->time_of(m.last_tick));
  const ImVec2 at = ImGui::GetWindowPos();
  const float text = ImGui::CalcTextSize(end.c_str()).x + 14;
  constexpr float sign = 26;
  Scale scale{at.x + 14 + sign + text, at.x + width - 14 - sign - text, m.first_tick, m.last_tick};
  const float y = at.y + 0.5f * height;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float line = y - 0.5f * ImGui::GetTextLineHeight();
  list.AddText({at.x + 14 + sign, line}, palette::dim, begin.c_str());
  list.AddText({scale.right + 14, line}, palette::dim, end.c_str());
  const auto here = std::ranges::find(m.marks->bookmarks, m.frame->tick, &Bookmark::tick);
  sign_button(context, "timeline.bookmark", {at.x + 8, at.y + 6}, true,
              here != m.marks->bookmarks.end(), "a bookmark here, or no longer",
              Action::toggle_bookmark);
  sign_button(context, "timeline.loop", {at.x + width - 32, at.y + 6}, false, m.marks->looping,
              "play the span over and over", Action::toggle_loop);
  ImGui::SetCursorScreenPos({scale.left - 8, at.y + 6});
  ImGui::InvisibleButton("##line", ImVec2(scale.right - scale.left + 16, height - 12));
  const UiRect place{scale.left, at.y, scale.right - scale.left, height};
  context.host.mark("timeline", place);
  const uint64_t under = tick_under(context, scale);
  if (ImGui::IsItemHovered() || ImGui::IsItemActive()) {
    std::string text = fmt::format("{:.2f} s, tick {}", m.clock->time_of(under), under);
    for (const Bookmark& b : m.marks->bookmarks)
      if (b.tick == under) text = b.name + ": " + text;
    ImGui::SetTooltip("%s", text.c_str());
  }
  // Only one seek is under way at a time, since going far back takes a while.
  uint64_t& asked = context.state.scrubbed_to;
  if (draw_new_span(context, under) || !ImGui::IsItemActive())
    asked = m.frame->tick;
  else if (asked == m.frame->tick && under != asked)
    context.ask(SeekTick{asked = under});
  draw_line(context, scale, y);
  ImGui::End();
  return rest;
}

}  // namespace tumble
