#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

/// Draws the times of the stages as bars with a common scale, on which the longest is full.
void draw_profile(PanelContext& context) {
  const History& history = *context.model.history;
  double longest = 1e-9;
  for (const History::Stage& s : history.stages()) longest = std::max(longest, s.smoothed);
  const float width = ImGui::GetContentRegionAvail().x, height = 17, label = 0.44f * width;
  ImGui::PushFont(context.host.fonts().small);
  int index = 0;
  for (const History::Stage& stage : history.stages()) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const uint32_t colour = palette::series[index++ % palette::series_count];
    list.AddText({at.x, at.y + 1}, palette::dim, stage.name.c_str());
    const std::string time = duration_text(stage.smoothed);
    const float time_width = ImGui::CalcTextSize(time.c_str()).x;
    const float room = width - label - 58;
    const float bar = std::max(2.0f, float(stage.smoothed / longest) * room);
    list.AddRectFilled({at.x + label, at.y + 4}, {at.x + label + bar, at.y + height - 4}, colour,
                       2);
    list.AddText({at.x + width - time_width, at.y + 1}, palette::text, time.c_str());
    ImGui::Dummy(ImVec2(width, height));
    context.host.mark(fmt::format("statistics.stage.{}", stage.name));
  }
  ImGui::PopFont();
}

void draw_step_plot(PanelContext& context) {
  std::array<Curve, 2> curves;
  curves[0] = {"step", palette::blue, {}};
  curves[1] = {"tick", palette::faded(palette::yellow, 0.5f), {}};
  const auto tick = float(context.model.frame->rate.tick());
  float greatest = 0;
  std::vector<double> times;
  for (const History::Sample& s : context.model.history->samples()) {
    times.push_back(s.time);
    curves[0].values.push_back(float(s.step_seconds));
    greatest = std::max(greatest, float(s.step_seconds));
  }
  // The tick (budget for real time) is only shown if the step time comes near it.
  if (greatest > 0.3f * tick) curves[1].values.assign(curves[0].values.size(), tick);
  plot(context, "statistics.plot", times, curves, 66, "s");
}

}  // namespace

void draw_statistics_panel(PanelContext& context) {
  const UiModel& m = context.model;
  const StepStats& stats = m.frame->stats;
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(8, 2));
  const double fps = m.picture_seconds > 0 ? 1 / m.picture_seconds : 0;
  value_row("pictures", fmt::format("{:.0f} per second", fps));
  value_row("drawing", fmt::format("{}, {} calls, {}k triangles", duration_text(m.drawing_seconds),
                                   m.draw_calls, m.triangles / 1000));
  value_row("bodies", fmt::format("{}, {} awake", stats.bodies, stats.awake));
  if (stats.particles > 0) value_row("particles", fmt::format("{}", stats.particles));
  value_row("islands", fmt::format("{}", stats.islands));
  value_row("bounds tested, found", fmt::format("{}, {}", stats.bounds_tested, stats.pairs_found));
  value_row("pairs, contacts, points",
            fmt::format("{}, {}, {}", stats.pairs, stats.contacts, stats.contact_points));
  value_row("deepest overlap", fmt::format("{:.3f} mm", stats.max_penetration * 1000),
            stats.max_penetration > 0.01 ? palette::red : 0);
  if (stats.events + stats.impacts + stats.fallbacks > 0)
    value_row("events, impacts", fmt::format("{}, {}", stats.events, stats.impacts));
  if (stats.fallbacks > 0)
    value_row("impacts in sequence", fmt::format("{}", stats.fallbacks), palette::yellow);
  if (stats.time_stepped > 0)
    value_row("groups time-stepped", fmt::format("{}", stats.time_stepped), palette::yellow);
  value_row("momentum", quantity_text(stats.momentum.norm(), "N s"));
  constexpr double mega = 1e6;
  value_row("past to go back to", fmt::format("{:.0f} of {:.0f} MB", double(m.past_bytes) / mega,
                                              double(m.past_budget) / mega));
  context.host.mark("statistics.past");
  tooltip_with_key(context,
                   "moments kept for scrubbing; the older they are the fewer remain, and what is "
                   "between them is computed again",
                   {});
  section(context, fmt::format("Step  {}", duration_text(m.history->smoothed_step())).c_str());
  draw_step_plot(context);
  ImGui::Dummy(ImVec2(0, 2));
  draw_profile(context);
  if (m.dropped_seconds > 0.05)
    small_text(context, fmt::format("{:.1f} s of real time dropped", m.dropped_seconds),
               palette::yellow);
  ImGui::Dummy(ImVec2(0, 1));
  small_text(context, m.renderer, palette::faint);
  ImGui::PopStyleVar();
}

}  // namespace tumble
