#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <iterator>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

namespace tumble {
namespace {

std::string tick_time(const PanelContext& context, uint64_t tick) {
  return fmt::format("{:.2f} s", context.model.clock->time_of(tick));
}

constexpr float in_row = 0;  ///< a button as high as the fields and text beside it

void draw_bookmark(PanelContext& context, const Bookmark& bookmark, size_t index) {
  ImGui::PushID(int(index));
  const float end = ImGui::GetContentRegionMax().x;
  const std::string time = tick_time(context, bookmark.tick);
  const float button = ImGui::CalcTextSize(time.c_str()).x + 2 * ImGui::GetStyle().FramePadding.x;
  ImGui::SetNextItemWidth(end - ImGui::GetCursorPosX() - button - 34);
  std::string name = bookmark.name;
  if (ImGui::InputText("##name", &name))
    context.ask(EditMarks{[tick = bookmark.tick, name](TimeMarks& marks) {
      for (Bookmark& b : marks.bookmarks)
        if (b.tick == tick) b.name = name;
    }});
  context.host.mark(fmt::format("bookmarks.{}.name", index));
  ImGui::SameLine(0, 4);
  if (word_button(context, fmt::format("bookmarks.{}.go", index), time.c_str(),
                  bookmark.tick == context.model.frame->tick, "go to this moment", {}, in_row))
    context.ask(GoToMoment{bookmark.tick});
  ImGui::SameLine(end - 22);
  if (icon_button(context, fmt::format("bookmarks.{}.close", index), Icon::close, "no longer", {},
                  20))
    context.ask(EditMarks{[index](TimeMarks& marks) { marks.remove(index); }});
  ImGui::PopID();
}

void draw_loop(PanelContext& context) {
  const UiModel& m = context.model;
  const TimeMarks& marks = *m.marks;
  section(context, "Loop");
  note("Shift + drag on the line of time marks a span, or:");
  const uint64_t now = m.frame->tick;
  if (ImGui::Button("From here"))
    context.ask(
        EditMarks{[now, last = m.last_tick](TimeMarks& all) { all.begin_span(now, last); }});
  context.host.mark("bookmarks.from");
  ImGui::SameLine();
  if (ImGui::Button("To here"))
    context.ask(
        EditMarks{[now, first = m.first_tick](TimeMarks& all) { all.end_span(now, first); }});
  context.host.mark("bookmarks.to");
  if (!marks.span) return;
  value_row("span", fmt::format("{} to {}", tick_time(context, marks.span->from),
                                tick_time(context, marks.span->to)));
  bool on = marks.looping;
  if (toggle(context, "bookmarks.loop", "play it over and over", on,
             shortcut_of(Action::toggle_loop)))
    context.ask(EditMarks{[on](TimeMarks& all) { all.looping = on; }});
}

std::string words_for(const std::string& followed) {
  return followed.empty() ? std::string("stands") : "with " + followed;
}

/// Choice of the body that a key follows; possible only at the key's time, when the body's pose is
/// known.
void draw_followed(PanelContext& context, const FlightKeyView& key, size_t index, bool here,
                   float width) {
  const std::string now = words_for(key.follow);
  if (!here) {
    ImGui::AlignTextToFramePadding();
    note(shortened(now, width));
    return;
  }
  // List at most this many bodies; in a larger scene only the selected one is offered.
  constexpr size_t most = 60;
  std::vector<std::string> names = {""};
  const Frame& frame = *context.model.frame;
  for (size_t slot = 0; slot < frame.body_slots(); ++slot) {
    const BodyId id = frame.body(slot).id;
    const BodyInfo& info = frame.info(slot);
    if (id.is_null() || info.type == BodyType::fixed || info.name.empty()) continue;
    if (names.size() < most || id == context.model.selected || info.name == key.follow)
      names.push_back(info.name);
  }
  ImGui::SetNextItemWidth(width);
  if (ImGui::BeginCombo("##follow", now.c_str())) {
    for (const std::string& name : names) {
      if (ImGui::Selectable(words_for(name).c_str(), name == key.follow))
        context.ask(FollowFromKey{index, name});
      context.host.mark(fmt::format("bookmarks.key.{}.{}", index, name.empty() ? "stands" : name));
    }
    ImGui::EndCombo();
  }
  context.host.mark(fmt::format("bookmarks.key.{}.follow", index));
  tooltip_with_key(context, "the camera moves along with this body", {});
}

void draw_flight(PanelContext& context) {
  const UiModel& m = context.model;
  section(context, "Flight of the camera");
  if (ImGui::Button("Key here and now")) context.ask(Action::add_camera_key);
  context.host.mark("bookmarks.key");
  tooltip_with_key(context, "the camera of now, at this moment",
                   shortcut_of(Action::add_camera_key));
  if (m.flight.empty()) return;
  const float end = ImGui::GetContentRegionMax().x;
  for (size_t i = 0; i < m.flight.size(); ++i) {
    ImGui::PushID(int(i));
    const std::string time = fmt::format("{:.2f} s", m.flight[i].time);
    const uint64_t tick = m.clock->tick_at(m.flight[i].time);
    const bool here = tick == m.frame->tick;
    if (word_button(context, fmt::format("bookmarks.key.{}.go", i), time.c_str(), here,
                    "go to this moment", {}, in_row))
      context.ask(GoToMoment{tick});
    ImGui::SameLine(0, 8);
    draw_followed(context, m.flight[i], i, here, end - ImGui::GetCursorPosX() - 30);
    ImGui::SameLine(end - 22);
    if (icon_button(context, fmt::format("bookmarks.key.{}.close", i), Icon::close, "no longer", {},
                    20))
      context.ask(RemoveFlightKey{i});
    ImGui::PopID();
  }
  bool flying = m.flying;
  if (toggle(context, "bookmarks.fly", "fly along the keys", flying,
             shortcut_of(Action::toggle_flight)))
    context.ask(Action::toggle_flight);
}

void draw_recording(PanelContext& context) {
  struct Way {
    const char *name, *text, *doc;
    Action action;
  };
  const bool on = context.model.recording;
  const Way ways[] = {
      {"bookmarks.pictures", on ? "End it" : "Pictures",
       on ? "the recording ends" : "a frame sequence, from now on", Action::toggle_sequence},
      {"bookmarks.video", "Video", "from now on", Action::toggle_video},
      {"bookmarks.replay", "Save replay", "what was done up to this moment", Action::save_replay},
      {"bookmarks.pack", "Save pack", "the scene and the replay in one file, for others",
       Action::save_packed_replay},
  };
  section(context, "Record");
  for (size_t i = 0; i < std::size(ways); ++i) {
    const Way& way = ways[i];
    if (way.action == Action::toggle_video && on) continue;
    if (i == 1 || i == 3) ImGui::SameLine();
    if (ImGui::Button(way.text)) context.ask(way.action);
    context.host.mark(way.name);
    tooltip_with_key(context, way.doc, shortcut_of(way.action));
  }
}

}  // namespace

void draw_bookmarks_panel(PanelContext& context) {
  const auto& all = context.model.marks->bookmarks;
  if (ImGui::Button("Bookmark this moment")) context.ask(Action::toggle_bookmark);
  context.host.mark("bookmarks.add");
  tooltip_with_key(context, "or take its bookmark away", shortcut_of(Action::toggle_bookmark));
  for (size_t i = 0; i < all.size(); ++i) draw_bookmark(context, all[i], i);
  draw_loop(context);
  draw_flight(context);
  draw_recording(context);
}

}  // namespace tumble
