#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

constexpr float margin = 12, height = 40, widest = 760;

/// Where a tick is on the line.
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

/// Ticks in which something happened that the filter of the list takes.
void draw_events(PanelContext& context, const Scale& scale, float y) {
  if (!context.model.events) return;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  float last = scale.left - 2;
  size_t marks = 0;
  for (const WorldEvent& e : *context.model.events) {
    if (e.tick < scale.first || e.tick > scale.last) continue;
    if (!context.state.event_filter.takes(e)) continue;
    const float x = scale.at(e.tick);
    if (x < last + 1) continue;  // one mark a pixel
    list.AddRectFilled({x - 0.75f, y + 4}, {x + 0.75f, y + 12}, palette::yellow);
    last = x;
    ++marks;
  }
  context.host.mark(fmt::format("timeline.events.{}", marks));
}

void draw_line(PanelContext& context, const Scale& scale, float y) {
  const UiModel& m = context.model;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float now = scale.at(m.frame->tick);
  list.AddRectFilled({scale.left, y - 2}, {scale.right, y + 2}, palette::raised, 2);
  list.AddRectFilled({scale.left, y - 2}, {now, y + 2}, palette::accent, 2);
  draw_events(context, scale, y);
  for (const uint64_t deed : m.deed_ticks)
    if (deed >= scale.first && deed <= scale.last)
      list.AddRectFilled({scale.at(deed) - 1.5f, y - 7}, {scale.at(deed) + 1.5f, y + 7},
                         palette::blue, 1);
  list.AddCircleFilled({now, y}, 7, palette::text);
}

}  // namespace

UiRect draw_timeline(PanelContext& context, const UiRect& free_area) {
  const UiModel& m = context.model;
  UiRect rest = free_area;
  const float width = std::min(widest, free_area.width - 2 * margin);
  if (!m.paused || m.last_tick <= m.first_tick || width < 160) return rest;
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
  const double tick = m.frame->rate.tick();
  const std::string begin = fmt::format("{:.2f} s", double(m.first_tick) * tick);
  const std::string end = fmt::format("{:.2f} s", double(m.last_tick) * tick);
  const ImVec2 at = ImGui::GetWindowPos();
  const float text = ImGui::CalcTextSize(end.c_str()).x + 14;
  Scale scale{at.x + 14 + text, at.x + width - 14 - text, m.first_tick, m.last_tick};
  const float y = at.y + 0.5f * height;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float line = y - 0.5f * ImGui::GetTextLineHeight();
  list.AddText({at.x + 14, line}, palette::dim, begin.c_str());
  list.AddText({scale.right + 14, line}, palette::dim, end.c_str());
  ImGui::SetCursorScreenPos({scale.left - 8, at.y + 6});
  ImGui::InvisibleButton("##line", ImVec2(scale.right - scale.left + 16, height - 12));
  const UiRect place{scale.left, at.y, scale.right - scale.left, height};
  context.host.mark("timeline", place);
  const uint64_t under = scale.tick(ImGui::GetIO().MousePos.x);
  if (ImGui::IsItemHovered() || ImGui::IsItemActive())
    ImGui::SetTooltip("%.2f s, tick %llu", double(under) * tick, (unsigned long long)under);
  // The next place is asked for when the last one is there: going far back takes a while.
  uint64_t& asked = context.state.scrubbed_to;
  if (!ImGui::IsItemActive())
    asked = m.frame->tick;
  else if (asked == m.frame->tick && under != asked)
    context.ask(SeekTick{asked = under});
  draw_line(context, scale, y);
  ImGui::End();
  return rest;
}

}  // namespace tumble
