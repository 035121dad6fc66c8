// Bookmarks, loops, camera flights and rulers.
#include "viewer/app/window/application.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

namespace tumble {
namespace {

bool is_same(const CameraKey& a, const CameraKey& b) {
  return a.time == b.time && a.camera.eye == b.camera.eye && a.camera.target == b.camera.target &&
         a.camera.fov_deg == b.camera.fov_deg && a.follow == b.follow && a.follow_x == b.follow_x;
}

/// Description of a change to a list in time order, with the time: "Set a bookmark at 0.40 s"; ""
/// if nothing changed.
template <class Mark>
std::string list_undo_step(const std::vector<Mark>& before, const std::vector<Mark>& now,
                           const char* of,
                           const std::function<bool(const Mark&, const Mark&)>& same,
                           const std::function<double(const Mark&)>& time_of) {
  const auto [b, n] = std::ranges::mismatch(before, now, same);
  if (b == before.end() && n == now.end()) return {};
  const char* verb = now.size() > before.size()   ? "Set"
                     : now.size() < before.size() ? "Delete"
                                                  : "Change";
  return fmt::format("{} {} at {:.2f} s", verb, of, time_of(now.size() < before.size() ? *b : *n));
}

std::string mark_undo_step(const SceneMarks& before, const SceneMarks& now,
                           const TickClock& clock) {
  const std::string undo_step = list_undo_step<Bookmark>(
      before.time.bookmarks, now.time.bookmarks, "a bookmark", std::equal_to<>(),
      [&](const Bookmark& b) { return clock.time_of(b.tick); });
  if (!undo_step.empty()) return undo_step;
  return list_undo_step<CameraKey>(before.flight, now.flight, "a key of the flight", is_same,
                                   [](const CameraKey& k) { return k.time; });
}

/// How far ahead the next event is looked for [s].
constexpr double most_searched = 20;

/// Greatest number of events of one tick that are named.
constexpr size_t most_said_events = 3;

/// "impacts of at least 0.5 N s with 'ball'".
std::string filter_words(const EventFilter& filter) {
  std::string out = filter.kind ? std::string(event_kind_name(*filter.kind)) : "everything";
  const bool impacts = !filter.kind || *filter.kind == WorldEventKind::impact;
  if (impacts && filter.least_impulse > 0)
    out += fmt::format(" of at least {:.3g} N s", filter.least_impulse);
  if (!filter.body.empty()) out += fmt::format(" with \"{}\" in its name", filter.body);
  return out;
}

}  // namespace

/// The key under which the marks of the scene shown are kept.
std::string Application::marked_scene() const {
  std::error_code none;
  const auto& file = scene_.file.ours ? scene_.file.path : scene_.file.read_from;
  return file.empty() ? scene_.name : std::filesystem::absolute(file, none).string();
}

/// Loads the marks of the scene shown.
void Application::open_marks(double tick_seconds) {
  own_flight_ = false;
  keep_marks(true);
  if (const Status opened = marks_.open(marked_scene(), tick_seconds); !opened)
    ui_.toast(ToastKind::warning, "The bookmarks of this scene cannot be read",
              {opened.error().text()});
}

void Application::keep_marks(bool once_more) {
  if (const Status kept = marks_.keep(once_more); !kept)
    ui_.toast(ToastKind::warning, "The bookmarks cannot be kept", {kept.error().text()});
}

/// To be called once per picture: jumps back at the end of the loop, and saves changed marks as
/// soon as no text is being typed.
void Application::look_at_marks() {
  if (!in_gesture()) keep_marks();
  if (session().paused() || recording()) return;
  const auto from = marks_.jump_back(world_.frame().tick, world_.view().generation);
  if (!from) return;
  session().seek(*from);
  session().set_paused(false);
}

void Application::edit_marks(const std::function<void(TimeMarks&)>& change) {
  change_marks([&](SceneMarks& marks) { change(marks.time); });
}

/// Changes of bookmarks and flight can be undone; the looped span is not part of undo.
void Application::change_marks(const std::function<void(SceneMarks&)>& change) {
  auto before = std::make_shared<SceneMarks>(marks_.marks());
  marks_.change(change);
  std::string what = mark_undo_step(*before, marks_.marks(), marks_.clock());
  if (what.empty()) return;
  undo_steps_.begin_beside(std::move(what), in_gesture(), [this, before] {
    marks_.change([&](SceneMarks& marks) {
      std::swap(marks.time.bookmarks, before->time.bookmarks);
      std::swap(marks.flight, before->flight);
    });
    follow_flight();
  });
}

/// A camera in flight continues along the changed keys.
void Application::follow_flight() {
  if (!own_flight_ || !camera_.flying()) return;
  marks_.marks().flight.empty() ? camera_.leave_path() : fly();
}

/// During a recording only it advances time: returns true then, and reports that `what` is not
/// possible.
bool Application::recording_forbids(const std::string& what) {
  if (recording())
    ui_.toast(ToastKind::info, "No " + what + " while recording",
              {"A recording goes on without a jump: end it first."});
  return recording();
}

/// Jumping back to the beginning of the span would undo what the user does in it.
void Application::leave_loop() {
  if (!marks_.marks().time.looping) return;
  edit_marks([](TimeMarks& marks) { marks.looping = false; });
  ui_.toast(ToastKind::info, "The loop is switched off",
            {"Going back would undo what was changed just now."});
}

void Application::jump_to_event() {
  instruments_.jump =
      session().step_until([watch = instruments_.events, filter = ui_.event_filter](
                               const Frame&, const Frame&) { return watch->just_happened(filter); },
                           most_searched);
}

/// Says which event was found, or that there was none.
void Application::look_at_jump() {
  auto& jump = instruments_.jump;
  if (!jump.valid() || jump.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  const Session::Search end = jump.get();
  if (end == Session::Search::left) return;
  std::erase_if(ui_.toasts, [&](const Toast& t) { return t.title == instruments_.jump_words; });
  std::vector<std::string> lines;
  if (end == Session::Search::nothing) {
    instruments_.jump_words = fmt::format("Nothing of this has happened in {} s", most_searched);
    lines.push_back(fmt::format("{} lists what has, and chooses what is looked for: now {}.",
                                shortcut_of(Action::toggle_events),
                                filter_words(ui_.event_filter)));
    return ui_.toast(ToastKind::info, instruments_.jump_words, std::move(lines));
  }
  const auto events = instruments_.events->events();
  std::vector<const WorldEvent*> found;
  for (const WorldEvent& e : *events)
    if (e.tick == events->back().tick && ui_.event_filter.takes(e)) found.push_back(&e);
  if (found.empty()) return;
  instruments_.jump_words = fmt::format("{:.2f} s, {}: {}", found[0]->time,
                                        event_kind_name(found[0]->kind), event_text(*found[0]));
  for (size_t i = 1; i < std::min(found.size(), most_said_events); ++i)
    lines.push_back(event_text(*found[i]));
  if (found.size() > most_said_events)
    lines.push_back(fmt::format("and {} more: {} lists them", found.size() - most_said_events,
                                shortcut_of(Action::toggle_events)));
  ui_.toast(ToastKind::info, instruments_.jump_words, std::move(lines));
}

/// Ticks that were not seen yet are computed; those that are too long ago are not kept any more.
void Application::go_to_moment(uint64_t tick) {
  if (recording_forbids("going to another moment")) return;
  const uint64_t first = session().counters().first_tick;
  if (tick < first)
    return ui_.toast(ToastKind::info,
                     fmt::format("Going back reaches to {:.2f} s only: {} restarts",
                                 marks_.clock().time_of(first), shortcut_of(Action::restart)));
  session().seek(tick);
}

void Application::toggle_loop() {
  if (recording_forbids("loop")) return;
  const TimeMarks& time = marks_.marks().time;
  std::optional<TickSpan> span = time.span;
  if (!span)
    span = time.span_about(world_.frame().tick, session().counters().first_tick,
                           std::max(undo_steps_.newest_tick(), world_.frame().tick));
  if (!span)
    return ui_.toast(ToastKind::info, "There is no span of time to loop yet",
                     {"Let some time pass, then Shift + drag on the line of time."});
  edit_marks([&](TimeMarks& marks) {
    marks.span = span;
    marks.looping = !marks.looping;
  });
  if (!marks_.marks().time.looping) return;
  session().seek(span->from);
  session().set_paused(false);
}

/// Adds the present camera as a key at this moment.
void Application::add_camera_key() {
  CameraKey key{world_.frame().time, camera_.camera(), {}};
  change_marks([&](SceneMarks& marks) {
    const auto same = std::ranges::find(marks.flight, key.time, &CameraKey::time);
    if (same != marks.flight.end()) {
      // A key that is replaced keeps the body that it followed.
      if (const auto x = place_of_body(same->follow)) {
        key.follow = same->follow;
        key.follow_x = *x;
      }
      marks.flight.erase(same);
    }
    const auto at = std::ranges::upper_bound(marks.flight, key.time, {}, &CameraKey::time);
    marks.flight.insert(at, key);
  });
  camera_.leave_path();
  ui_.shows(PanelId::bookmarks) = true;
}

std::optional<Vec3> Application::place_of_body(const std::string& name) const {
  const Frame& frame = world_.frame();
  for (size_t slot = 0; slot < frame.body_slots(); ++slot)
    if (!name.empty() && !frame.body(slot).id.is_null() && frame.info(slot).name == name)
      return frame.body(slot).pose.x;
  return std::nullopt;
}

void Application::follow_from_key(const FollowFromKey& wanted) {
  const auto& flight = marks_.marks().flight;
  if (wanted.index >= flight.size()) return;
  const auto x = place_of_body(wanted.body);
  if (!wanted.body.empty() && !x)
    return ui_.toast(ToastKind::info, "There is no body " + wanted.body + " at this moment");
  if (x && marks_.clock().tick_at(flight[wanted.index].time) != world_.frame().tick)
    return ui_.toast(ToastKind::info, "A key follows from its own moment on: go there first",
                     {"Its time in the list is a button that does."});
  change_flight([&](std::vector<CameraKey>& keys) {
    keys[wanted.index].follow = wanted.body;
    keys[wanted.index].follow_x = x.value_or(Vec3::Zero());
  });
}

/// A camera in flight continues along the changed keys.
void Application::change_flight(const std::function<void(std::vector<CameraKey>&)>& change) {
  change_marks([&](SceneMarks& marks) { change(marks.flight); });
  if (own_flight_ && camera_.flying() && !marks_.marks().flight.empty()) return fly();
  camera_.leave_path();
}

void Application::toggle_flight() {
  const auto& flight = marks_.marks().flight;
  if (flight.empty())
    return ui_.toast(ToastKind::info, fmt::format("No flight yet: {} makes a key of it",
                                                  shortcut_of(Action::add_camera_key)));
  if (own_flight_ && camera_.flying()) return camera_.leave_path();
  fly();
  if (flight.size() > 1 && world_.frame().time >= flight.back().time)
    ui_.toast(ToastKind::info, "This flight has come to its end",
              {fmt::format("Its keys are at {:.2f} s to {:.2f} s: go back there, or restart by {}.",
                           flight.front().time, flight.back().time, shortcut_of(Action::restart))});
}

/// Starts the flight along the user's keys.
void Application::fly() {
  own_flight_ = true;
  ViewPoint view = scene_.view;
  view.follow = {};
  view.path = marks_.marks().flight;
  camera_.look_from(view, world_.view());
}

/// Saves the plot as an image of its own, in the colours of the panels.
void Application::save_plot() {
  if (instruments_.measures.series().empty()) return;
  constexpr double width = 960, height = 600;
  // A separate UI with the same fonts, so that the panels keep the keyboard focus.
  UiHost page_host;
  page_host.set_scale(host_.scale());
  page_host.set_theme(ui_.theme);
  page_host.begin(width, height, 1.0 / 60, {}, true);
  const UiModel m = model();
  std::vector<UiRequest> nobody;
  PanelContext context{page_host, m, ui_, nobody, 0};
  draw_plot_page(context, float(width), float(height));
  RenderScene page;
  page.ground.visible = false;
  page.ui_scale = float(layout_.size.scale);
  page_host.end(page.ui);
  const auto drawn = canvas_.renderer().render(page, int(std::lround(width * layout_.size.scale)),
                                               int(std::lround(height * layout_.size.scale)));
  if (!drawn)
    return ui_.toast(ToastKind::error, "The plot cannot be drawn", {drawn.error().text()});
  const auto saved = screenshots_.save(canvas_.renderer(), scene_.name + "-plot");
  if (saved)
    ui_.toast(ToastKind::info, "Plot " + saved->filename().string());
  else
    ui_.toast(ToastKind::error, "The plot cannot be written", {saved.error().text()});
}

/// Handles a click while the ruler is active.
void Application::rule_at(const std::optional<Pick>& hit) {
  if (!hit) return ui_.toast(ToastKind::info, "The ruler begins and ends on a surface");
  if (instruments_.ruler.full())
    return ui_.toast(ToastKind::info, "There is room for no more readings: close one first");
  (void)instruments_.ruler.click(world_.view(), *hit, ui_.ruling_angle);
}

/// True when the action was one of these.
bool Application::perform_in_time(Action action) {
  const uint64_t tick = world_.frame().tick;
  const TimeMarks& time = marks_.marks().time;
  const auto jump = [&](const Bookmark* to) {
    if (to) return go_to_moment(to->tick);
    ui_.toast(ToastKind::info, time.bookmarks.empty()
                                   ? fmt::format("No bookmark yet: {} sets one",
                                                 shortcut_of(Action::toggle_bookmark))
                                   : std::string("There is no bookmark further on"));
  };
  const auto flip_panel = [&](PanelId id) { ui_.shows(id) = !ui_.shows(id); };
  switch (action) {
    case Action::toggle_bookmark:
      edit_marks([&](TimeMarks& marks) { marks.toggle(tick); });
      return true;
    case Action::next_bookmark:
      jump(time.next(tick));
      return true;
    case Action::previous_bookmark:
      jump(time.previous(tick));
      return true;
    case Action::toggle_loop:
      toggle_loop();
      return true;
    case Action::add_camera_key:
      add_camera_key();
      return true;
    case Action::toggle_flight:
      toggle_flight();
      return true;
    case Action::toggle_bookmarks:
      flip_panel(PanelId::bookmarks);
      return true;
    case Action::toggle_ruler:
      flip_panel(PanelId::ruler);
      ui_.ruling = ui_.shows(PanelId::ruler);
      instruments_.ruler.cancel();
      return true;
    default:
      return false;
  }
}

/// True when the request was one of these.
bool Application::apply_in_time(const UiRequest& request) {
  if (const auto* edit = std::get_if<EditMarks>(&request)) {
    edit_marks(edit->change);
  } else if (const auto* moment = std::get_if<GoToMoment>(&request)) {
    go_to_moment(moment->tick);
  } else if (const auto* reading = std::get_if<RemoveReading>(&request)) {
    instruments_.ruler.remove(reading->index);
  } else if (const auto* key = std::get_if<RemoveFlightKey>(&request)) {
    change_flight([&](std::vector<CameraKey>& keys) {
      if (key->index < keys.size()) keys.erase(keys.begin() + std::ptrdiff_t(key->index));
    });
  } else if (const auto* followed = std::get_if<FollowFromKey>(&request)) {
    follow_from_key(*followed);
  } else if (const auto* curve = std::get_if<AddNamedCurve>(&request)) {
    if (scene_.quantities) add_curve(scene_.quantities->find(curve->name));
  } else if (std::holds_alternative<LeavePast>(request)) {
    instruments_.measures.forget_past();
    instruments_.past.forget();
  } else if (std::holds_alternative<WritePlot>(request)) {
    plot_wanted_ = true;
  } else {
    return false;
  }
  return true;
}

}  // namespace tumble
