#include "viewer/app/application.hpp"

#include "viewer/app/application_state.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace tumble {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  size_t begin = 0;
  while (begin < text.size()) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    if (end > begin) lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

}  // namespace

Application::Application(ApplicationOptions options)
    : options_(std::move(options)), settings_(std::make_shared<SharedSettings>()) {}

Application::~Application() = default;

Result<std::unique_ptr<Application>> Application::create(Device& device, ApplicationOptions options,
                                                         OpenedScene scene) {
  std::unique_ptr<Application> app(new Application(std::move(options)));
  if (Status s = app->start(device, std::move(scene)); !s) return s.error();
  return app;
}

Status Application::start(Device& device, OpenedScene scene) {
  auto renderer = Renderer::create(device, options_.shaders);
  if (!renderer) return renderer.error();
  renderer_ = std::move(*renderer);
  renderer_name_ = device.info().renderer;
  software_ = device.info().software;
  renderer_->set_font(host_.atlas());
  show(std::move(scene));
  if (options_.hints)
    ui_.toast(ToastKind::info,
              "Drag a body to pull it, drag elsewhere to orbit. F1 shows all keys.");
  return {};
}

void Application::show(OpenedScene scene) {
  if (recorder_.active()) perform(Action::toggle_sequence);
  end_drag();
  pointer_.cancel();
  selected_ = {};
  look_into({});
  history_.clear();
  snapshot_.reset();
  meshes_.microscope().clear();
  ui_.microscope = {};
  picked_for_microscope_ = false;
  ui_.shows(PanelId::microscope) = scene.microscope.has_value();
  ui_.content_height[size_t(PanelId::inspector)] = 0;
  const std::shared_ptr<const Frame> first = scene.world->frame();
  settings_ = std::make_shared<SharedSettings>();
  settings_->value = scene_settings_ = scene.world->settings();
  if (session_) {
    world_ = session_->replace(std::move(scene.world));
    if (!options_.own_thread) (void)session_->advance(0);
  } else {
    session_ = std::make_unique<Session>(std::move(scene.world));
    if (options_.own_thread) session_->start();
  }
  view_ = {first, first, 1, 0, world_};
  generation_ = 0;
  slow_pictures_ = 0;
  render_scene_ = RenderScene{};
  if (scene.look) scene.look(render_scene_);
  camera_.set(scene.view.camera);
  carried_to_ = scene.view.camera.target;
  if (!scene.warnings.empty()) ui_.toast(ToastKind::warning, "The scene says:", scene.warnings);
  scene_ = std::move(scene);
}

void Application::finish() {
  if (recorder_.active()) perform(Action::toggle_sequence);
}

void Application::open(const std::string& name_or_path) {
  if (options_.own_thread)
    loader_.start(options_.open, name_or_path);
  else
    finish_opening(name_or_path, options_.open(name_or_path));
}

void Application::finish_opening(const std::string& asked, Result<OpenedScene> opened) {
  if (opened) {
    ui_.toasts.clear();
    return show(std::move(*opened));
  }
  const std::string file = std::filesystem::path(asked).filename().string();
  ui_.toast(ToastKind::error, "'" + file + "' cannot be opened", lines_of(opened.error().text()));
}

void Application::advance(double dt) {
  if (options_.own_thread) return;
  uint64_t ticks = 0;
  if (!session_->paused()) {
    // Rounded up a little, so that 60 pictures of 1/60 s are 60 ticks of 1/60 s.
    behind_ticks_ += dt * session_->speed() / view_.to->rate.tick();
    ticks = uint64_t(behind_ticks_ + 1e-6);
    behind_ticks_ = std::max(0.0, behind_ticks_ - double(ticks));
  }
  (void)session_->advance(ticks);
}

void Application::look_at_view() {
  const SessionView now = session_->view();
  if (now.world != world_) return;  // not there yet: its first frame is shown meanwhile
  view_ = now;
  recorder_.show(view_);
  carry_camera();
  if (view_.generation != generation_) {
    if (generation_ != 0) {
      end_drag();
      fetch_settings();
    }
    generation_ = view_.generation;
  }
  history_.add(*view_.to);
  // Closed by its button: nobody looks any more.
  if (!ui_.shows(PanelId::contact)) probe_.clear();
  probe_.update(*session_, view_.to);
  forget_what_is_gone();
  const std::optional<Error> fault = session_->fault();
  const std::string text = fault ? fault->text() : std::string();
  if (!text.empty() && text != shown_fault_)
    ui_.toast(ToastKind::error, "The simulation has stopped at the last good tick", {text});
  shown_fault_ = text;
}

/// The camera goes along with the body that the scene's camera follows, and keeps what the person
/// did to it.
void Application::carry_camera() {
  if (!find_slot(*view_.to, scene_.view.follow)) return;
  const Vec3 target = scene_.view.at(*view_.from, *view_.to, view_.s).target;
  camera_.carry(target - carried_to_);
  carried_to_ = target;
}

void Application::forget_what_is_gone() {
  if (selected_ && !find_slot(*view_.to, selected_)) selected_ = {};
  if (pointer_.drag().active() && !find_slot(*view_.to, pointer_.drag().body())) end_drag();
}

UiModel Application::model() {
  UiModel m;
  m.frame = view_.to;
  m.scenes = &options_.scenes;
  m.scene_name = scene_.name;
  m.scene_title = scene_.title;
  m.scene_doc = scene_.doc;
  m.opening = std::filesystem::path(loader_.asked()).filename().string();
  m.opening_seconds = loader_.seconds();
  {
    std::lock_guard lock(settings_->mutex);
    m.settings = settings_->value;
  }
  const SessionCounters counters = session_->counters();
  m.threads = options_.threads;
  m.paused = counters.paused && !recorder_.active();
  m.speed = counters.speed;
  m.behind = counters.behind;
  m.tick_seconds = counters.tick_seconds;
  m.dropped_seconds = counters.dropped_seconds;
  m.first_tick = counters.first_tick;
  m.next_tick = counters.tick + 1;
  m.under_way_seconds = counters.under_way_seconds;
  m.fault = session_->fault();
  m.picture_seconds = picture_seconds_;
  m.drawing_seconds = drawing_seconds_;
  m.renderer = renderer_name_;
  m.draw_calls = report_.draws.draws;
  m.triangles = report_.draws.triangles;
  m.history = &history_;
  m.selected = selected_;
  m.contact = probe_.view();
  m.has_snapshot = snapshot_ != nullptr;
  m.recording = recorder_.active();
  m.recorded_frames = recorder_.frames();
  if (const auto setup = extract_options().microscope) {
    m.microscope = meshes_.microscope().recording();
    m.microscope_step = meshes_.microscope().shown();
    m.microscope_algorithm = setup->algorithm;
    m.microscope_refusal = meshes_.microscope().refusal();
  }
  return m;
}

Status Application::frame(std::span<const InputEvent> events, double dt, const Picture& picture) {
  const auto start = std::chrono::steady_clock::now();
  ++frames_;
  picture_seconds_ += (picture_seconds_ == 0 ? 1 : 0.08) * (dt - picture_seconds_);
  if (host_.set_scale(picture.scale)) renderer_->set_font(host_.atlas());
  if (picture.width < 1 || picture.height < 1) return {};  // minimised
  const double width = picture.width / picture.scale, height = picture.height / picture.scale;
  aspect_ = width / height;
  width_ = picture.width;
  height_ = picture.height;

  if (auto loaded = loader_.take()) finish_opening(loaded->asked, std::move(loaded->scene));
  if (recorder_.active())
    recorder_.advance(*session_);
  else
    advance(dt);
  look_at_view();

  std::vector<UiRequest> requests;
  host_.begin(width, height, dt, in_time_for_search(events), pointer_is_taken(events, dt));
  const UiModel m = model();
  PanelContext context{host_, m, ui_, requests, dt};
  free_area_ = draw_ui(context, width, height);
  const Ground& ground = render_scene_.ground;
  camera_.set_floor(ground.visible ? std::optional(ground.height) : std::nullopt);
  route(events, dt, picture);
  for (const UiRequest& request : requests) apply(request);
  host_.end(ui_list_);

  camera_.update(dt);
  if (Status s = take_screenshots(picture); !s)
    ui_.toast(ToastKind::error, "The picture cannot be written", {s.error().text()});
  if (Status s = draw(picture); !s) return s;
  if (want_screenshot_) {
    want_screenshot_ = false;
    if (Status s = save_picture(); !s)
      ui_.toast(ToastKind::error, "The picture cannot be written", {s.error().text()});
  }
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
  drawing_seconds_ += (drawing_seconds_ == 0 ? 1 : 0.08) * (spent.count() - drawing_seconds_);
  if (frames_ % 600 == 0) {
    meshes_.prune();
    renderer_->forget_unused_meshes();
  }
  return {};
}

std::optional<ScriptedInput::Point> Application::locate(std::string_view place) const {
  if (const auto rect = host_.find(place))
    return ScriptedInput::Point{double(rect->x) + 0.5 * double(rect->width),
                                double(rect->y) + 0.5 * double(rect->height)};
  if (!view_.to) return std::nullopt;
  const double width = double(ui_list_.width), height = double(ui_list_.height);
  const auto seen_at = [&](const Vec3& x_world) -> std::optional<ScriptedInput::Point> {
    const Vec3 x = project(camera_.camera(), x_world, width, height);
    if (!(x.z() > 0)) return std::nullopt;
    return ScriptedInput::Point{x.x(), x.y()};
  };
  if (place == "contact") {
    std::optional<Vec3> first;
    view_.to->for_contacts([&first](const ContactFrame& c) { first = first.value_or(c.x_world); });
    if (first) return seen_at(*first);
  }
  if (!place.starts_with("body:")) return std::nullopt;
  const std::string_view name = place.substr(5);
  for (size_t slot = 0; slot < view_.to->body_slots(); ++slot) {
    if (view_.to->body(slot).id.is_null() || view_.to->info(slot).name != name) continue;
    const auto point = seen_at(interpolated_pose(*view_.from, *view_.to, slot, view_.s).x);
    if (point) return point;
  }
  return std::nullopt;
}

}  // namespace tumble
