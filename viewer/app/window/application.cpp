#include "viewer/app/window/application.hpp"

#include "engine/world/world.hpp"
#include "viewer/app/scenes/scene_assertions.hpp"
#include "viewer/app/scenes/scene_lesson.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Switches off the overlays of the last scene and on those of the next; what the user chose stays.
void switch_overlays(const Overlays& last, const Overlays& next, Overlays& shown) {
  for (const OverlayEntry& entry : all_overlays()) {
    const auto on = entry.enabled;
    shown.*on = (shown.*on && !(last.*on)) || next.*on;
  }
}

}  // namespace

Application::Application(ApplicationOptions options, Canvas canvas)
    : options_(std::move(options)),
      canvas_(std::move(canvas)),
      world_(options_.own_thread),
      undo_steps_(options_.unsaved_folder),
      marks_(options_.preferences_file.empty()
                 ? std::filesystem::path()
                 : options_.preferences_file.parent_path() / "bookmarks.json"),
      screenshots_(options_.capture_folder),
      thumbnails_(options_.thumbnail_folder, options_.thumbnail_program) {
  canvas_.renderer().set_font(host_.atlas());
  ui_.theme = options_.preferences.theme;
  ui_.zoom = options_.preferences.zoom;
}

Application::~Application() = default;

Result<std::unique_ptr<Application>> Application::create(Device& device, ApplicationOptions options,
                                                         OpenedScene scene) {
  auto canvas = Canvas::create(device, options.shaders);
  if (!canvas) return canvas.error();
  const bool hints = options.hints;
  std::unique_ptr<Application> app(new Application(std::move(options), std::move(*canvas)));
  if (scene.file.unnamed) scene.file.path = app->undo_steps_.unsaved().free_name();
  app->show(std::move(scene));
  if (const auto& faults = app->options_.faults; !faults.empty())
    app->ui_.toast(ToastKind::warning, "Of your files for keys and window", faults);
  if (hints)
    app->ui_.toast(ToastKind::info,
                   "Drag a body to pull it, drag elsewhere to orbit. F1 shows all keys.");
  return app;
}

void Application::show(OpenedScene scene, bool goes_on) {
  // Includes the newest changes before the application ends.
  if (world_.any()) undo_steps_.finish(session(), options_.own_thread);
  if (recording()) toggle_recording();
  end_drag();
  mouse_pull_.forget();
  pointer_.cancel();
  selection_.clear();
  second_.forget();
  undo_steps_.forget();
  removal_trial_.reset();
  tools_.open(scene.parts, scene.live_parts);
  ui_.part = {};
  ui_.pulled_parameters.clear();
  look_into({});
  instruments_.open(scene.microscope);
  canvas_.meshes().microscope().clear();
  ui_.microscope = {};
  ui_.shows(PanelId::microscope) = scene.microscope.has_value();
  ui_.content_height[size_t(PanelId::inspector)] = 0;
  switch_overlays(scene_.overlays, scene.overlays, ui_.overlays);
  if (!goes_on) ui_.pins = {};
  if (!goes_on) ui_.trail.reset();
  if (!goes_on) building_overlays_.end(scene.overlays, ui_.overlays);
  settings_.open(scene.world->settings());
  canvas_.open(scene.look, scene.trail);
  camera_.open(scene.view, *scene.world->frame());
  TickWatchers watchers = {instruments_.events};
  if (scene.assertions) watchers.push_back(scene.assertions);
  if (scene.lesson && scene_.lesson && scene.request.scene == scene_.request.scene)
    scene.lesson->go_on_from(*scene_.lesson);
  if (scene.lesson) watchers.push_back(scene.lesson);
  // Closed by hand, it stays so while the scene goes on.
  if (!goes_on || !scene.assertions || !scene_.assertions)
    ui_.shows(PanelId::assertions) = scene.assertions != nullptr;
  const double tick_seconds = scene.world->frame()->rate.tick();
  world_.show(std::move(scene.world), std::move(watchers), scene.replay);
  if (scene.replay) ui_.toast(ToastKind::info, "A replay", {scene.replay_words});
  if (!scene.warnings.empty()) ui_.toast(ToastKind::warning, "The scene says:", scene.warnings);
  scene_file_.open(scene.file);
  replay_.open(scene, options_.threads);
  undo_steps_.unsaved().open(scene.file, goes_on);
  question_.forget();
  ui_.shows(PanelId::save) = false;
  scene_ = std::move(scene);
  open_marks(tick_seconds);
  begin_lesson();
  if (!goes_on) offer_kept_work();
}

void Application::finish() {
  if (recording()) toggle_recording();
  replay_.saver().finish(session());
  undo_steps_.finish(session(), options_.own_thread);
  keep_marks(true);
}

void Application::look_at_view() {
  using enum ShownWorld::News;
  const uint64_t seen_last = world_.frame().tick;
  const ShownWorld::News news = world_.look();
  if (news == none) return;
  camera_.carry(world_.view());
  canvas_.see(world_.frame(), news != ahead);
  if (news != goes_on) {
    end_drag();
    mouse_pull_.let_go_of_the_past(session());
    settings_.fetch(session(), follows_replay());
  }
  if (const auto copies = tools_.duplicator.take(world_.frame()); !copies.empty()) {
    selection_.clear();
    for (const BodyId copy : copies) selection_.add(copy);
    // While building, the inspector would cover the place of the next click.
    if (!ui_.building) open_inspector();
  }
  undo_steps_.see(world_.frame().tick, news != goes_on);
  marks_.clock().see(world_.frame().tick, world_.frame().time, world_.frame().rate.tick());
  instruments_.history.add(world_.frame());
  instruments_.measures.see(world_.frame(), world_.frame().tick < undo_steps_.newest_tick());
  // The ticks between were not seen.
  if (news == ahead || (session().paused() && world_.frame().tick > seen_last + 1))
    instruments_.measures.want_past();
  if (news != goes_on) instruments_.past.note_jump();
  instruments_.past.update(session(), instruments_.measures, options_.own_thread);
  instruments_.ruler.update(world_.frame());
  if (news == ahead) second_.restart_trail();
  second_.update(world_.frame(), own_choice());
  // Closed by its button: the inspection ends.
  if (!ui_.shows(PanelId::contact)) instruments_.probe.clear();
  instruments_.probe.update(session(), world_.view().to);
  // A recording makes its own queries, at the ticks that it shows.
  const auto looked_at = instruments_.microscope.setup(ui_.microscope);
  instruments_.microscope_probe.update(session(), world_.view().to,
                                       recording() ? std::nullopt : looked_at);
  forget_what_is_gone();
  if (news != goes_on) undo_steps_.select_as_then(world_.frame(), selection_);
  tools_.selected_def.update(session(), world_.frame(), selection_.main());
  tools_.pinned_defs.update(session(), world_.frame(), ui_.pins);
  take_mesh_modes();
  show_notices();
}

void Application::show_notices() {
  look_at_replay();
  if (const auto fault = world_.take_fault())
    ui_.toast(ToastKind::error, "The simulation has stopped at the last good tick", {*fault});
  if (const auto refusal = settings_.take_refusal())
    ui_.toast(ToastKind::warning, "This setting is not possible", {refusal->text()});
  if (const auto refusal = tools_.refusal.take())
    ui_.toast(ToastKind::warning, "This is not possible", {refusal->text()});
  if (auto along = tools_.refusal.take_told(); !along.empty())
    ui_.toast(ToastKind::info, "What needed it is gone, too", std::move(along));
  warn_of_removal();
}

/// The running world goes on without what was deleted, where its file may not open any more: water
/// without a floor falls for ever.
void Application::warn_of_removal() {
  if (auto left = tools_.refusal.take_left())
    removal_trial_ = std::make_unique<OpeningTrial>(
        *std::move(left), scene_.file.pack.empty() ? scene_.file.path : scene_.file.read_from,
        options_.own_thread);
  const auto opens = removal_trial_ ? removal_trial_->take() : std::nullopt;
  if (!opens) return;
  removal_trial_.reset();
  if (*opens) return;
  ui_.toast(ToastKind::warning, "Without it this scene does not open again",
            {opens->error().message,
             fmt::format("{} brings it back; or put something in its place ({} builds), or delete "
                         "what needs it, before you save.",
                         shortcut_of(Action::undo), shortcut_of(Action::toggle_build))});
}

void Application::forget_what_is_gone() {
  selection_.keep_if([&](BodyId id) { return find_slot(world_.frame(), id).has_value(); });
  if (dragging() && !find_slot(world_.frame(), pointer_.drag().body())) end_drag();
}

UiModel Application::model() const {
  UiModel m;
  m.frame = world_.view().to;
  m.scenes = &options_.scenes;
  m.thumbnails = &thumbnails_.pictures();
  m.folder = browsed();
  m.start_folder =
      scene_.file.path.has_parent_path() ? scene_.file.path.parent_path().string() : ".";
  m.scene_name = scene_.name;
  m.scene_title = scene_.title;
  m.scene_doc = scene_.doc;
  m.parameters = &scene_.parameters;
  m.opening = std::filesystem::path(opening_.asked()).filename().string();
  m.opening_seconds = opening_.seconds();
  m.settings = settings_.value();
  const SessionCounters counters = world_.session().counters();
  m.threads = options_.threads;
  m.paused = counters.paused && !recording();
  m.speed = counters.speed;
  m.behind = counters.behind;
  m.tick_seconds = counters.tick_seconds;
  m.dropped_seconds = counters.dropped_seconds;
  m.first_tick = counters.first_tick;
  m.last_tick = std::max(undo_steps_.newest_tick(), m.frame->tick);
  m.undo_step_ticks = undo_steps_.edits().ticks_of_this_course();
  m.next_tick = counters.tick + 1;
  m.under_way_seconds = counters.under_way_seconds;
  m.way_to = counters.way_to;
  m.searching = counters.searching;
  m.trail = trail();
  m.past_bytes = counters.keyframe_bytes;
  m.past_budget = SessionOptions{}.keyframe_bytes;
  m.asking = counters.asking;
  m.asking_seconds = counters.asking_seconds;
  m.fault = world_.session().fault();
  m.picture_seconds = canvas_.pace().picture_seconds();
  m.drawing_seconds = canvas_.pace().drawing_seconds();
  m.renderer = canvas_.renderer_name();
  m.draw_calls = report().draws.draws;
  m.triangles = report().draws.triangles;
  m.history = &instruments_.history;
  m.comparison = second_.comparison();
  m.measures = &instruments_.measures;
  m.past_share = instruments_.past.share();
  m.marks = &marks_.marks().time;
  m.clock = &marks_.clock();
  m.ruler = &instruments_.ruler.view();
  m.quantity_names = scene_.quantities ? scene_.quantities->names : nullptr;
  for (const CameraKey& key : marks_.marks().flight) m.flight.push_back({key.time, key.follow});
  m.flying = own_flight_ && camera_.flying();
  m.selected = selection_.main();
  m.selected_count = selection_.size();
  if (tools_.box)
    m.selection_box = UiRect{float(std::min(tools_.box->x0, tools_.box->x1) + pointer_.origin()),
                             float(std::min(tools_.box->y0, tools_.box->y1)),
                             float(std::abs(tools_.box->x1 - tools_.box->x0)),
                             float(std::abs(tools_.box->y1 - tools_.box->y0))};
  if (ui_.shows(PanelId::events) || m.paused) m.events = instruments_.events->events();
  if (scene_.assertions) m.assertions = scene_.assertions->views();
  m.lesson = lesson_view();
  m.selected_def = tools_.selected_def.def();
  m.selected_joints = tools_.selected_def.joints();
  m.pinned = tools_.pinned_defs.all();
  m.parts = tools_.parts.parts();
  m.measured_mesh = tools_.mesh_modes.measured();
  m.measuring_mesh = tools_.mesh_modes.measuring();
  m.changing_mesh = tools_.mesh_modes.changing();
  m.reading_mesh = tools_.mesh_palette.reading();
  m.palette_fault = tools_.mesh_palette.fault();
  m.description = description_.view();
  m.contact = instruments_.probe.view();
  m.has_snapshot = world_.has_snapshot();
  m.question = question_.question();
  m.save = scene_file_.preview();
  m.recording = recording();
  m.recorded_frames = world_.recorder().frames();
  if (const auto setup = extract_options().microscope) {
    const MicroscopeView& view = canvas_.meshes().microscope();
    m.microscope = view.recording();
    m.microscope_step = view.shown();
    m.microscope_algorithm = setup->algorithm;
    m.microscope_refusal = view.refusal();
    m.microscope_waits = instruments_.microscope_probe.waits();
  }
  return m;
}

Status Application::frame(std::span<const InputEvent> input, double dt, const Picture& picture) {
  canvas_.pace().begin_picture(dt, picture.display_period);
  if (host_.set_scale(picture.scale)) canvas_.renderer().set_font(host_.atlas());
  if (picture.width < 1 || picture.height < 1) return {};  // minimised
  paced_input_.add(input);
  const std::vector<InputEvent> events = paced_input_.take();
  layout_.size = picture;
  host_.set_theme(ui_.theme);
  keep_preferences();
  const double width = picture.width / picture.scale, height = picture.height / picture.scale;

  if (auto opened = opening_.take()) finish_opening(*std::move(opened));
  if (auto opened = second_.take_opened()) show_second(*std::move(opened));
  world_.recorder().look_through(instruments_.microscope.setup(ui_.microscope));
  world_.advance(dt);
  canvas_.set_trail(trail());
  second_.set_trail(trail());
  look_at_view();
  look_at_marks();
  look_at_jump();

  keep_hints();
  look_at_description();
  tools_.parts.update(session(), undo_steps_.edits().file_edits());
  look_at_files(dt);
  scene_file_.update(ui_.save_file);
  if (const auto* mesh = std::get_if<NewMesh>(&ui_.build.what); mesh && ui_.building) {
    const Camera& seen = camera_.camera();
    tools_.mesh_palette.choose(*mesh, Builder::usual_size((seen.target - seen.eye).norm()),
                               options_.own_thread);
    (void)tools_.mesh_palette.ready();
  }
  // The names to search are those that exist when the search begins.
  const bool searched = !ui_.plot.search.empty(), begun = searched && !searched_;
  searched_ = searched;
  if (begun && scene_.quantities) scene_.quantities = scene_.quantities->with(world_.frame());
  std::vector<UiRequest> requests;
  host_.begin(width, height, dt, in_time_for_search(events), pointer_.is_taken(events, dt));
  const UiModel m = model();
  PanelContext context{host_, m, ui_, requests, dt};
  layout_.free_area = draw_ui(context, width, height);
  layout_.area = layout_.area_in(layout_.free_area, stands_beside());
  pointer_.move_to(layout_.area);
  camera().set_heightening(layout_.area.heightening());
  camera_.stay_above(canvas_.picture().ground);
  route(events, dt);
  for (const UiRequest& request : requests) apply(request);
  if (ui_.building && !ui_.shows(PanelId::build)) end_building();  // closed by its button
  host_.end(layout_.panels);
  if (ui_.shows(PanelId::scenes))
    thumbnails_.update(options_.scenes, ui_.seen_scenes, canvas_.renderer());

  camera().update(dt);
  if (std::exchange(plot_wanted_, false)) save_plot();
  if (screenshots_.wants_plain()) save_plain_screenshot();
  if (Status s = draw(); !s) return s;
  if (screenshots_.take(true)) save_screenshot();
  canvas_.pace().end_picture();
  if (canvas_.pace().pictures() % 600 == 0) canvas_.prune();
  return {};
}

/// Saves theme and scale when they have changed.
void Application::keep_preferences() {
  const Preferences now{ui_.theme, ui_.zoom};
  if (now == options_.preferences) return;
  options_.preferences = now;
  if (const Status kept = write_preferences(options_.preferences_file, now); !kept)
    ui_.toast(ToastKind::warning, "This choice cannot be kept", {kept.error().text()});
}

std::optional<ScriptedInput::Point> Application::locate(std::string_view place) const {
  if (const auto rect = host_.find(place))
    return ScriptedInput::Point{double(rect->x) + 0.5 * double(rect->width),
                                double(rect->y) + 0.5 * double(rect->height)};
  if (!world_.any()) return std::nullopt;
  const double width = layout_.area.width(), height = layout_.area.height();
  const auto seen_at = [&](const Vec3& x_world) -> std::optional<ScriptedInput::Point> {
    const Vec3 x = project(camera_.seen(), x_world, width, height);
    if (!(x.z() > 0)) return std::nullopt;
    return ScriptedInput::Point{layout_.area.left() + x.x(), x.y()};
  };
  if (place == "contact") {
    std::optional<Vec3> first;
    world_.frame().for_contacts(
        [&first](const ContactFrame& c) { first = first.value_or(c.x_world); });
    if (first) return seen_at(*first);
  }
  if (place.starts_with("handle:")) {
    const auto at = handle_grip(place.substr(7));
    return at ? seen_at(*at) : std::nullopt;
  }
  if (!place.starts_with("body:")) return std::nullopt;
  const std::string_view name = place.substr(5);
  const SessionView& shown = world_.view();
  for (size_t slot = 0; slot < world_.frame().body_slots(); ++slot) {
    if (world_.frame().body(slot).id.is_null() || world_.frame().info(slot).name != name) continue;
    const auto point = seen_at(interpolated_pose(*shown.from, *shown.to, slot, shown.s).x);
    if (point) return point;
  }
  return std::nullopt;
}

}  // namespace tumble
