#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

namespace tumble {
namespace {

/// Greatest number of lines shown; others can be found with a filter.
constexpr size_t most_shown_events = 200;

void draw_kind(PanelContext& context, EventFilter& filter) {
  const std::string shown(filter.kind ? event_kind_name(*filter.kind) : "everything");
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##kind", shown.c_str())) {
    if (ImGui::Selectable("everything", !filter.kind)) filter.kind.reset();
    context.host.mark("events.kind.everything");
    for (size_t k = 0; k < world_event_kinds; ++k) {
      const auto kind = WorldEventKind(k);
      std::string name(event_kind_name(kind));
      if (ImGui::Selectable(name.c_str(), filter.kind == kind)) filter.kind = kind;
      std::ranges::replace(name, ' ', '_');
      context.host.mark("events.kind." + name);
    }
    ImGui::EndCombo();
  }
  context.host.mark("events.kind");
}

void draw_filter(PanelContext& context) {
  EventFilter& filter = context.state.event_filter;
  draw_kind(context, filter);
  ImGui::SetNextItemWidth(-1);
  ImGui::InputTextWithHint("##body", "of a body: a part of its name", &filter.body);
  context.host.mark("events.body");
  if (filter.kind && *filter.kind != WorldEventKind::impact) return;
  ImGui::SetNextItemWidth(-1);
  ImGui::InputDouble("##impulse", &filter.least_impulse, 0, 0, "impulse of at least %.3g N s");
  filter.least_impulse = std::max(filter.least_impulse, 0.0);
  context.host.mark("events.impulse");
}

std::string event_words(const WorldEvent& e) {
  if (e.kind != WorldEventKind::impact) return event_text(e);
  return fmt::format("{} against {}, {}", e.name_a, e.name_b, quantity_text(e.impulse, "N s"));
}

void draw_event(PanelContext& context, const WorldEvent& e, size_t index) {
  ImGui::PushID(int(index));
  const float width = ImGui::GetContentRegionAvail().x;
  const std::string line =
      fmt::format("{:.2f} s  {}", e.time,
                  context.state.event_filter.kind
                      ? event_words(e)
                      : fmt::format("{}: {}", event_kind_name(e.kind), event_words(e)));
  const bool now = e.tick == context.model.frame->tick;
  if (ImGui::Selectable(shortened(line, width).c_str(), now)) {
    context.ask(SeekTick{e.tick});
    if (e.a) context.ask(SelectBody{e.a});
  }
  context.host.mark(fmt::format("events.{}", index));
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", line.c_str());
  ImGui::PopID();
}

}  // namespace

void draw_events_panel(PanelContext& context) {
  draw_filter(context);
  if (!context.model.events) return;
  std::vector<const WorldEvent*> chosen;
  for (const WorldEvent& e : *context.model.events)
    if (context.state.event_filter.takes(e)) chosen.push_back(&e);
  if (chosen.empty()) return note("Nothing of this has happened yet.");
  small_text(context,
             fmt::format("{} of {}, the newest first", chosen.size(), context.model.events->size()),
             palette::dim);
  const size_t lines = std::min(chosen.size(), most_shown_events);
  for (size_t i = 0; i < lines; ++i) draw_event(context, *chosen[chosen.size() - 1 - i], i);
}

}  // namespace tumble
