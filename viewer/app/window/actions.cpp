#include "engine/world/world.hpp"
#include "viewer/app/editing/edits_at_start.hpp"
#include "viewer/app/scenes/scene_lesson.hpp"
#include "viewer/app/verify/differences.hpp"
#include "viewer/app/window/application.hpp"
#include "viewer/app/window/open_scene.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace tumble {
namespace {

Action flip(bool& value, Action action) {
  value = !value;
  return action;
}

/// Zoom in steps of a tenth, so that steps back give exactly the values before.
double zoom_step(double zoom, int steps) {
  return std::clamp(0.1 * (std::round(10 * zoom) + steps), least_zoom, greatest_zoom);
}

}  // namespace

void Application::perform(Action action) {
  Overlays& overlays = ui_.overlays;
  if (perform_in_time(action)) return;
  switch (action) {
    case Action::toggle_pause:
      if (recording()) return toggle_recording();
      return session().set_paused(!session().paused());
    case Action::step_forward:
      return session().step(1);
    case Action::step_forward_ten:
      return session().step(10);
    case Action::next_impact:
      return jump_to_event();
    case Action::step_back:
      return session().step(-1);
    case Action::step_back_ten:
      return session().step(-10);
    case Action::restart:
      return restart(false);
    case Action::restart_as_scene:
      return restart(true);
    case Action::slower:
      return session().set_speed(std::max(session().speed() / 2, 1.0 / 64));
    case Action::faster:
      return session().set_speed(std::min(session().speed() * 2, 16.0));
    case Action::previous_scene:
      return neighbour_scene(-1);
    case Action::next_scene:
      return neighbour_scene(1);
    case Action::pick_scene:
      ui_.hidden = false;
      ui_.shows(PanelId::help) = false;
      ui_.choosing_mesh = false;
      flip(ui_.shows(PanelId::scenes), action);
      browse({});
      thumbnails_.look_again(options_.scenes);
      early_text_.clear();
      ui_.search_opened = ui_.shows(PanelId::scenes);
      return;
    case Action::new_scene:
      return open(OpenRequest{new_scene_file(), {}, {}});
    case Action::save_scene:
      return save_scene();
    case Action::undo:
      return take_back();
    case Action::redo:
      return do_again();
    case Action::duplicate:
      return duplicate_selected();
    case Action::copy:
      return copy_selected();
    case Action::paste:
      return paste();
    case Action::select_all:
      return select_all();
    case Action::handles_move:
      return show_handles(HandleKind::move);
    case Action::handles_turn:
      return show_handles(HandleKind::turn);
    case Action::handles_scale:
      return show_handles(HandleKind::scale);
    case Action::delete_body:
      return delete_selected();
    case Action::save_snapshot:
      world_.keep_snapshot();
      return ui_.toast(ToastKind::info,
                       fmt::format("Snapshot of tick {} kept", world_.frame().tick));
    case Action::restore_snapshot:
      if (!world_.has_snapshot())
        return ui_.toast(ToastKind::info, fmt::format("No snapshot yet: {} keeps one",
                                                      shortcut_of(Action::save_snapshot)));
      end_drag();
      undo_steps_.jump(false);
      return world_.restore_snapshot();
    case Action::screenshot:
      return screenshots_.want(true);
    case Action::screenshot_plain:
      return screenshots_.want(false);
    case Action::toggle_sequence:
      return toggle_recording();
    case Action::toggle_video:
      return toggle_recording(true);
    case Action::save_replay:
      return save_replay(false);
    case Action::save_packed_replay:
      return save_replay(true);
    case Action::scene_camera:
      if (std::exchange(own_flight_, false)) return camera_.look_from(scene_.view, world_.view());
      return camera_.go_back(world_.view());
    case Action::frame_all:
      return camera_.frame_all(world_.frame(), aspect());
    case Action::toggle_free_flight:
      return pointer_.set_free_flight(!pointer_.tool().free_flight());
    case Action::fly_forward:
    case Action::fly_back:
    case Action::fly_left:
    case Action::fly_right:
    case Action::fly_up:
    case Action::fly_down:
      return;  // only in flight mode and while held: PointerTool handles them
    case Action::close:
      return close_something();
    case Action::toggle_panels:
      flip(ui_.hidden, action);
      return;
    case Action::toggle_help:
      ui_.hidden = false;
      ui_.shows(PanelId::scenes) = false;
      flip(ui_.shows(PanelId::help), action);
      return;
    case Action::toggle_statistics:
      flip(ui_.shows(PanelId::statistics), action);
      return;
    case Action::toggle_energy:
      flip(ui_.shows(PanelId::energy), action);
      return;
    case Action::toggle_build:
      flip(ui_.shows(PanelId::build), action);
      ui_.building = false;
      tools_.builder.cancel();
      return;
    case Action::toggle_measure:
      flip(ui_.shows(PanelId::measure), action);
      return;
    case Action::toggle_compare:
      flip(ui_.shows(PanelId::compare), action);
      return;
    case Action::next_comparison_view:
      return next_comparison_view();
    case Action::toggle_events:
      flip(ui_.shows(PanelId::events), action);
      return;
    case Action::toggle_assertions:
      if (!scene_.assertions) return ui_.toast(ToastKind::info, "This scene asserts nothing");
      flip(ui_.shows(PanelId::assertions), action);
      return;
    case Action::toggle_lesson:
      if (!scene_.lesson) return ui_.toast(ToastKind::info, "This scene teaches nothing");
      flip(ui_.shows(PanelId::lesson), action);
      return;
    case Action::toggle_description:
      flip(ui_.shows(PanelId::description), action);
      break;
    case Action::toggle_parts:
      flip(ui_.shows(PanelId::parts), action);
      return;
    case Action::lesson_next:
      if (scene_.lesson) turn_lesson_page(scene_.lesson->step() + 1);
      return;
    case Action::lesson_back:
      if (scene_.lesson && scene_.lesson->step() > 0) turn_lesson_page(scene_.lesson->step() - 1);
      return;
    case Action::larger:
      ui_.zoom = zoom_step(ui_.zoom, 1);
      return;
    case Action::smaller:
      ui_.zoom = zoom_step(ui_.zoom, -1);
      return;
    case Action::next_theme:
      ui_.theme = ui_.theme == Theme::dark ? Theme::light : Theme::dark;
      return;
    case Action::full_screen:
      flip(full_screen_, action);
      return;
    case Action::quit:
      return ask_to_quit();
    case Action::toggle_microscope:
      return toggle_microscope();
    case Action::microscope_next:
      return go_to_microscope_step(canvas_.meshes().microscope().shown() + 1);
    case Action::microscope_previous:
      return go_to_microscope_step(canvas_.meshes().microscope().shown() - 1);
    case Action::microscope_first:
      return go_to_microscope_step(0);
    case Action::overlay_contacts:
      return flip_overlay(&Overlays::contacts, action);
    case Action::overlay_normals:
      return flip_overlay(&Overlays::normals, action);
    case Action::overlay_forces:
      return flip_overlay(&Overlays::forces, action);
    case Action::overlay_friction:
      return flip_overlay(&Overlays::friction_cones, action);
    case Action::overlay_bounds:
      return flip_overlay(&Overlays::aabbs, action);
    case Action::overlay_hierarchy:
      return change_hierarchy_level(1);
    case Action::overlay_hierarchy_back:
      return change_hierarchy_level(-1);
    case Action::overlay_grid:
      return flip_overlay(&Overlays::grid, action);
    case Action::overlay_joints:
      return flip_overlay(&Overlays::joints, action);
    case Action::overlay_collision_shape:
      return flip_overlay(&Overlays::collision_shape, action);
    case Action::overlay_velocities:
      return flip_overlay(&Overlays::velocities, action);
    case Action::overlay_momenta:
      return flip_overlay(&Overlays::momenta, action);
    case Action::overlay_total_forces:
      return flip_overlay(&Overlays::total_forces, action);
    case Action::toggle_bookmark:
    case Action::next_bookmark:
    case Action::previous_bookmark:
    case Action::toggle_loop:
    case Action::add_camera_key:
    case Action::toggle_flight:
    case Action::toggle_bookmarks:
    case Action::toggle_ruler:
      return;  // handled by perform_in_time()
    case Action::overlay_none: {
      const std::string kind = overlays.hierarchy_kind;
      const double length = overlays.vector_length;
      overlays = Overlays{};
      overlays.hierarchy_kind = kind;  // a choice of kind is not a switch
      overlays.vector_length = length;
      return;
    }
  }
}

/// Reports an overlay that is switched on but has nothing to show; otherwise the key would seem to
/// have no effect.
void Application::flip_overlay(bool Overlays::*overlay, Action action) {
  bool& on = ui_.overlays.*overlay;
  on = !on;
  if (!on || shows_anything(overlay)) return;
  for (const OverlayEntry& entry : all_overlays())
    if (entry.enabled == overlay)
      ui_.toast(ToastKind::info,
                fmt::format("{} is on, and shows nothing at this moment", shortcut_of(action)),
                {fmt::format("It shows {}.", entry.doc)});
}

/// Whether an overlay adds anything to the present picture.
bool Application::shows_anything(bool Overlays::*overlay) {
  const auto marks = [&](bool on) {
    ExtractOptions options;
    options.overlays.*overlay = on;
    options.before = world_.view().before;
    RenderScene drawn;
    const SessionView& shown = world_.view();
    extract(*shown.from, *shown.to, shown.s, options, canvas_.meshes(), drawn);
    return drawn.instances.size() + drawn.lines.size() + drawn.points.size() + drawn.texts.size();
  };
  return marks(true) > marks(false);
}

/// Cycles through off, level 0 (the root), 1, ... the leaves, and off again.
void Application::change_hierarchy_level(int by) {
  Overlays& overlays = ui_.overlays;
  const auto depth = hierarchy_depth(world_.frame(), extract_options(), canvas_.meshes());
  if (!depth) {
    overlays.hierarchy = false;
    return ui_.toast(ToastKind::info, "No triangle mesh here: only meshes have a hierarchy");
  }
  const int rounds = *depth + 2, now = overlays.hierarchy ? overlays.hierarchy_level + 1 : 0;
  const int next = (std::min(now, *depth + 1) + by + rounds) % rounds;
  overlays.hierarchy = next > 0;
  if (next > 0) overlays.hierarchy_level = next - 1;
}

/// Shows or hides the panel. If the scene has put nothing under the microscope, the selected body
/// and its neighbour are put there while the panel is shown.
void Application::toggle_microscope() {
  bool& shown = ui_.shows(PanelId::microscope);
  if (instruments_.microscope.take_away()) {
    canvas_.meshes().microscope().clear();
    shown = false;
    return;
  }
  if (instruments_.microscope.empty() && (!selection_.empty() || !shown)) {
    ui_.microscope = {};
    const bool put = instruments_.microscope.put(world_.frame(), selection_.main());
    if (!put && !selection_.empty())
      return ui_.toast(ToastKind::info, "No microscope takes this body");
    shown = true;
    return;
  }
  flip(shown, Action::toggle_microscope);
}

/// From then on the step does not advance with time.
void Application::go_to_microscope_step(int step) {
  const MicroscopeRecording* recording = canvas_.meshes().microscope().recording();
  if (!recording && instruments_.microscope_probe.waits())
    return ui_.toast(ToastKind::info,
                     fmt::format("It is watched in a world that stands still: press {}",
                                 shortcut_of(Action::toggle_pause)));
  if (!recording)
    return ui_.toast(ToastKind::info,
                     fmt::format("Nothing is under the microscope: select a body and press {}",
                                 shortcut_of(Action::toggle_microscope)));
  ui_.microscope.step = std::clamp(step, 0, int(recording->steps.size()) - 1);
}

void Application::apply(const UiRequest& request) {
  if (apply_in_time(request)) return;
  if (const auto* action = std::get_if<Action>(&request)) {
    perform(*action);
  } else if (const auto* scene = std::get_if<OpenScene>(&request)) {
    open(scene->name);
  } else if (const auto* folder = std::get_if<BrowseFolder>(&request)) {
    browse(folder->path);
  } else if (const auto* change = std::get_if<ChangeSettings>(&request)) {
    change_settings(change->settings);
  } else if (const auto* parameter = std::get_if<ChangeParameter>(&request)) {
    change_parameter(*parameter);
  } else if (const auto* edit = std::get_if<EditBody>(&request)) {
    edit_body(*edit);
  } else if (const auto* mode = std::get_if<ChangeMeshMode>(&request)) {
    tools_.mesh_modes.change(*mode);
  } else if (const auto* measured = std::get_if<MeasureMesh>(&request)) {
    tools_.mesh_modes.measure(*measured);
  } else if (const auto* way = std::get_if<DisplaceSelected>(&request)) {
    displace_selected(way->way);
  } else if (const auto* threads = std::get_if<ChangeThreads>(&request)) {
    options_.threads = threads->threads;
    session().post([n = threads->threads](World& world) { world.set_threads(n); });
  } else if (const auto* speed = std::get_if<ChangeSpeed>(&request)) {
    session().set_speed(speed->speed);
  } else if (std::holds_alternative<CancelQuestion>(request)) {
    session().cancel_question();
  } else if (std::holds_alternative<CancelTick>(request)) {
    const SessionCounters now = session().counters();
    session().cancel_tick();
    const uint64_t given_up = now.way_to > 0 ? now.way_to : now.tick + 1;
    ui_.toast(ToastKind::info,
              fmt::format("{}ick {} is given up: paused at tick {}",
                          now.way_to > 0 ? "The way to t" : "T", given_up, now.tick));
  } else if (const auto* write = std::get_if<WriteScene>(&request)) {
    write_scene(write->file);
  } else if (const auto* joint_edit = std::get_if<EditJoint>(&request)) {
    edit_joint(*joint_edit);
  } else if (const auto* joint = std::get_if<RemoveJoint>(&request)) {
    remove_joint(joint->id);
  } else if (const auto* chosen = std::get_if<Compare>(&request)) {
    compare(chosen->choice);
  } else if (std::holds_alternative<EndCompare>(request)) {
    second_.end(session());
  } else if (const auto* described = std::get_if<EditDescription>(&request)) {
    edit_description(*described);
  } else if (const auto* left = std::get_if<LeaveDraft>(&request)) {
    left->newest_only ? take_back_draft() : description_.leave_draft();
  } else if (const auto* part = std::get_if<EditPart>(&request)) {
    edit_part(*part);
  } else if (const auto* part_gone = std::get_if<RemovePart>(&request)) {
    remove_part(*part_gone);
  } else if (const auto* said = std::get_if<AnswerQuestion>(&request)) {
    question_.answer(said->choice, ui_);
  } else if (const auto* curve = std::get_if<AddCurve>(&request)) {
    add_curve(curve->quantity);
  } else if (const auto* gone = std::get_if<RemoveCurve>(&request)) {
    instruments_.measures.remove(gone->index);
  } else if (std::holds_alternative<WriteMeasures>(request)) {
    write_measures();
  } else if (const auto* page = std::get_if<TurnLessonPage>(&request)) {
    turn_lesson_page(page->page);
  } else if (const auto* answer_said = std::get_if<AnswerLesson>(&request)) {
    answer_lesson(answer_said->said);
  } else if (std::holds_alternative<TakeLessonChoice>(request)) {
    take_lesson_choice();
  } else if (const auto* seek = std::get_if<SeekTick>(&request)) {
    session().seek(seek->tick);
  } else if (const auto* select = std::get_if<SelectBody>(&request)) {
    selection_.set(select->id);
  } else if (const auto* look = std::get_if<SelectContact>(&request)) {
    look_into(look->contact);
  } else if (const auto* focus = std::get_if<FocusBody>(&request)) {
    camera_.frame_body(world_.frame(), focus->id, aspect());
  }
}

/// What was built and edited is part of the scene as its file would have it, and stays; pulls,
/// shots and motion are undone.
void Application::restart(bool as_scene) {
  const WorldSettings now = settings_.value(), of_scene = settings_.of_scene();
  if (as_scene && !follows_replay() && !changed_settings(now, of_scene).empty())
    begin_edit("Restart with the scene's settings")->push_back(ChangedSettings{now, of_scene});
  instruments_.history.clear();
  const std::vector<std::string> changed = settings_.restart(
      session(), as_scene,
      [undo_steps = undo_steps_.edits().file_edits(), parts = tools_.parts.opened(),
       live = tools_.parts.live(), refusal = tools_.refusal](World& world) {
        do_at_start(world, undo_steps, parts, live, refusal);
      });
  undo_steps_.jump(!changed.empty());
  undo_steps_.edits().begin_course();
  if (changed.empty()) return;
  const std::string names = fmt::format("{}", fmt::join(changed, ", "));
  if (as_scene)
    ui_.toast(ToastKind::info, "Restarted as the scene has it", {"Was changed: " + names});
  else
    ui_.toast(
        ToastKind::info, "Restarted with the settings chosen here",
        {"Kept: " + names, shortcut_of(Action::restart_as_scene) + " goes back to the scene's"});
}

/// The choices with which the world shown was made.
WorldChoice Application::own_choice() const {
  WorldChoice choice;
  choice.settings = settings_.value();
  choice.threads = options_.threads;
  for (const SceneParameter& p : scene_.parameters) choice.numbers.emplace_back(p.name, p.value);
  return choice;
}

/// Another choice for an existing world B is an undo step beside world A.
void Application::compare(const WorldChoice& wanted) {
  if (const WorldComparison* now = second_.comparison())
    undo_steps_.begin_beside("Change what is chosen for B", in_gesture(),
                             [this, other = now->choice]() mutable {
                               const WorldComparison* shown = second_.comparison();
                               if (!shown) return;
                               const WorldChoice those = std::exchange(other, shown->choice);
                               begin_comparison(those);
                             });
  begin_comparison(wanted);
}

/// Other numbers make a different scene, which is opened in the background; a change of settings
/// only continues from this moment.
void Application::begin_comparison(const WorldChoice& wanted) {
  WorldChoice of_file = own_choice();
  of_file.settings = settings_.of_scene();
  const std::vector<WorldDifference> different = differences(of_file, wanted);
  const auto is_number = [](const WorldDifference& d) { return d.path.starts_with("parameters."); };
  if (std::ranges::none_of(different, is_number)) return second_.begin(session(), wanted, trail());
  if (recording_forbids("comparing from the start")) return;
  undo_steps_.finish(session(), options_.own_thread);
  OpenRequest request = scene_.request;
  if (undo_steps_.unsaved().any()) request.text = undo_steps_.unsaved().text();
  for (std::string& one : overrides_of(different)) request.overrides.push_back(std::move(one));
  if (options_.own_thread) return second_.open(options_.open, std::move(request), wanted);
  show_second({wanted, options_.open(request)});
}

/// Both worlds begin at the start of the scene.
void Application::show_second(ComparisonController::Opened opened) {
  if (!opened.scene)
    return ui_.toast(ToastKind::error, "The scene cannot be opened with the numbers of B",
                     {opened.scene.error().text()});
  restart(false);
  second_.begin(session(), std::move(opened.choice), trail(), opened.scene->world.get());
}

/// For a quantity added late the past is computed.
void Application::add_curve(Quantity quantity) {
  Measures& measures = instruments_.measures;
  const size_t before = measures.series().size();
  measures.add(std::move(quantity), world_.frame());
  if (measures.series().size() > before && world_.frame().tick > session().counters().first_tick)
    measures.want_past(before);
}

void Application::toggle_recording(bool video) {
  Recorder& recorder = world_.recorder();
  Recording wanted = new_recording();
  wanted.video = video;
  const bool is_video = recorder.active() ? recorder.video() : video;
  const Status s = recorder.active() ? recorder.stop(session()) : recorder.start(session(), wanted);
  if (!s)
    return ui_.toast(ToastKind::error, is_video ? "No video" : "No sequence", {s.error().text()});
  if (recorder.active())
    ui_.toast(ToastKind::info, "Recording to " + recorder.folder().string());
  else
    ui_.toast(ToastKind::info,
              fmt::format("{} frames in {}", recorder.frames(), recorder.folder().string()));
}

void Application::neighbour_scene(int direction) {
  const auto& scenes = options_.scenes;
  if (scenes.empty()) return;
  // Pressed again while a scene is being opened, it continues from that one.
  const std::string& from = opening_.asked().empty() ? scene_.name : opening_.asked();
  const auto it = std::find_if(scenes.begin(), scenes.end(),
                               [&](const SceneItem& s) { return s.name == from; });
  const auto count = std::ptrdiff_t(scenes.size());
  // For a file that is not in the list, both directions lead into the list.
  std::ptrdiff_t index = it == scenes.end() ? (direction > 0 ? -1 : 0) : it - scenes.begin();
  index = (index + direction + count) % count;
  open(scenes[size_t(index)].name);
}

}  // namespace tumble
