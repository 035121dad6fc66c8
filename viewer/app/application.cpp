#include "viewer/app/application.hpp"

#include "viewer/app/application_state.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace tumble {
namespace {

constexpr double field_of_view_deg = 40;

/// Bounds of what moves, or of everything finite when nothing does.
Aabb bounds_of(const Frame& frame) {
  Aabb moving, all;
  for (size_t slot = 0; slot < frame.body_slots(); ++slot) {
    if (frame.body(slot).id.is_null()) continue;
    const Aabb b = body_bounds(frame, uint32_t(slot));
    if (b.empty()) continue;
    all.include(b);
    if (frame.info(slot).type == BodyType::dynamic) moving.include(b);
  }
  return moving.empty() ? all : moving;
}

}  // namespace

Application::Application(ApplicationOptions options)
    : options_(std::move(options)),
      settings_(std::make_shared<SharedSettings>()),
      snapshot_(std::make_shared<Snapshot>()) {}

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
  end_drag();
  pointer_.cancel();
  selected_ = {};
  history_.clear();
  snapshot_ = std::make_shared<Snapshot>();
  has_snapshot_ = false;
  ui_.content_height[size_t(PanelId::inspector)] = 0;
  const std::shared_ptr<const Frame> first = scene.world->frame();
  settings_ = std::make_shared<SharedSettings>();
  settings_->value = scene.world->settings();
  if (session_) {
    session_->replace(std::move(scene.world));
    if (!options_.own_thread) (void)session_->advance(0);
  } else {
    session_ = std::make_unique<Session>(std::move(scene.world));
    if (options_.own_thread) session_->start();
  }
  view_ = {first, first, 1, 0};
  generation_ = 0;
  slow_pictures_ = 0;
  render_scene_ = RenderScene{};
  if (scene.look) scene.look(render_scene_);
  camera_.set(scene.camera ? *scene.camera
                           : frame_bounds(bounds_of(*first), Vec3(0.6, 0.45, 1), field_of_view_deg,
                                          aspect_));
  if (!scene.warnings.empty()) ui_.toast(ToastKind::warning, "The scene says:", scene.warnings);
  scene_ = std::move(scene);
}

void Application::open(const std::string& name_or_path) {
  Result<OpenedScene> opened = options_.open(name_or_path);
  if (!opened) {
    const Error& error = opened.error();
    std::vector<std::string> lines;
    size_t begin = 0;
    const std::string text = error.text();
    while (begin <= text.size()) {
      const size_t end = std::min(text.find('\n', begin), text.size());
      if (end > begin) lines.push_back(text.substr(begin, end - begin));
      begin = end + 1;
    }
    std::erase_if(ui_.toasts, [](const Toast& t) { return t.kind == ToastKind::error; });
    const std::string file = std::filesystem::path(name_or_path).filename().string();
    ui_.toast(ToastKind::error, "'" + file + "' cannot be opened", std::move(lines));
    return;
  }
  std::erase_if(ui_.toasts, [](const Toast&) { return true; });
  show(std::move(*opened));
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
  view_ = session_->view();
  if (view_.generation != generation_) {
    if (generation_ != 0) {
      end_drag();
      fetch_settings();
    }
    generation_ = view_.generation;
  }
  history_.add(*view_.to);
  forget_what_is_gone();
  const std::optional<Error> fault = session_->fault();
  const std::string text = fault ? fault->text() : std::string();
  if (!text.empty() && text != shown_fault_)
    ui_.toast(ToastKind::error, "The simulation has stopped at the last good tick", {text});
  shown_fault_ = text;
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
  m.fault = session_->fault();
  m.picture_seconds = picture_seconds_;
  m.drawing_seconds = drawing_seconds_;
  m.renderer = renderer_name_;
  m.draw_calls = report_.draws.draws;
  m.triangles = report_.draws.triangles;
  m.history = &history_;
  m.selected = selected_;
  m.has_snapshot = has_snapshot_;
  m.recording = recorder_.active();
  m.recorded_frames = recorder_.frames();
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

  if (recorder_.active())
    recorder_.advance(*session_, options_.own_thread);
  else
    advance(dt);
  look_at_view();

  std::vector<UiRequest> requests;
  host_.begin(width, height, dt, events, pointer_.busy());
  const UiModel m = model();
  PanelContext context{host_, m, ui_, requests, dt};
  free_area_ = draw_ui(context, width, height);
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
  if (!place.starts_with("body:") || !view_.to) return std::nullopt;
  const std::string_view name = place.substr(5);
  for (size_t slot = 0; slot < view_.to->body_slots(); ++slot) {
    if (view_.to->body(slot).id.is_null() || view_.to->info(slot).name != name) continue;
    const double width = double(ui_list_.width), height = double(ui_list_.height);
    const Vec3 x =
        project(camera_.camera(), interpolated_pose(*view_.from, *view_.to, slot, view_.s).x, width,
                height);
    if (x.z() > 0) return ScriptedInput::Point{x.x(), x.y()};
  }
  return std::nullopt;
}

}  // namespace tumble
