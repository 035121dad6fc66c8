#include "viewer/app/window/canvas.hpp"

#include <utility>

namespace tumble {
namespace {

constexpr double fluent = 0.05;  ///< a picture that takes longer is slow [s]
constexpr int patience = 20;     ///< slow pictures in a row until drafts are drawn

/// Pictures count as still when nothing has moved for this long [s].
constexpr double rest = 0.25;

bool same_moment(const SessionView& a, const SessionView& b) {
  return a.from == b.from && a.to == b.to && a.s == b.s;
}
bool same_view(const Camera& a, const Camera& b) {
  return a.eye == b.eye && a.target == b.target && a.up == b.up && a.fov_deg == b.fov_deg;
}

void smooth(double& mean, double now) {
  mean += (mean == 0 ? 1 : 0.08) * (now - mean);
}

}  // namespace

void DrawingPace::begin_picture(double dt, double period) {
  dt_ = dt;
  begun_ = Clock::now();
  ++pictures_;
  smooth(picture_seconds_, dt);
  if (std::exchange(reduced_, false)) control_.see(dt, period);
}

void DrawingPace::end_picture() {
  smooth(drawing_seconds_, std::chrono::duration<double>(Clock::now() - begun_).count());
  if (!is_slow()) slow_pictures_ = drawing_seconds_ > fluent ? slow_pictures_ + 1 : 0;
}

float DrawingPace::use_resolution(bool still) {
  rest_ = still ? rest_ + dt_ : 0;
  reduced_ = rest_ < rest;
  if (!reduced_) return 1;
  return control_.resolution();
}

bool DrawingPace::is_slow() const {
  return slow_pictures_ >= patience;
}

Result<Canvas> Canvas::create(Device& device, const std::filesystem::path& shaders) {
  auto renderer = Renderer::create(device, shaders);
  if (!renderer) return renderer.error();
  Canvas canvas;
  canvas.renderer_ = std::move(*renderer);
  canvas.renderer_name_ = device.info().renderer;
  canvas.software_ = device.info().software;
  return canvas;
}

void Canvas::open(const std::function<void(RenderScene&)>& look, double trail_seconds) {
  picture_ = RenderScene{};
  shown_ = {};
  if (look) look(picture_);
  trail_seconds_ = trail_seconds;
  trails_.start(trail_seconds);
}

void Canvas::set_trail(double seconds) {
  if (seconds == trail_seconds_) return;
  trail_seconds_ = seconds;
  trails_.start(seconds);
  shown_ = {};  // the picture is another one, though nothing moves
}

void Canvas::see(const Frame& frame, bool way_is_known) {
  if (!way_is_known) trails_.start(trail_seconds_);
  trails_.see(frame);
}

void Canvas::compose(const SessionView& shown, const ExtractOptions& options,
                     const Camera& camera) {
  still_ = same_moment(shown, shown_) && same_view(camera, picture_.camera);
  shown_ = shown;
  extract(*shown.from, *shown.to, shown.s, options, meshes_, picture_);
  trails_.draw(*shown.from, *shown.to, shown.s, picture_);
  picture_.camera = camera;
}

Status Canvas::draw(UiDrawList& panels, int width, int height) {
  picture_.ui = std::move(panels);
  return take(renderer_->render(picture_, width, height), panels);
}

Status Canvas::draw_beside(const RenderScene& right, const SideBySide& places, UiDrawList& panels,
                           int width, int height) {
  picture_.ui = std::move(panels);
  return take(renderer_->render_beside(picture_, right, places, width, height), panels);
}

Status Canvas::take(Result<FrameReport> report, UiDrawList& panels) {
  panels = std::move(picture_.ui);
  if (!report) return report.error();
  report_ = *report;
  return {};
}

Quality Canvas::quality(PictureQuality wanted, bool captured) const {
  switch (wanted) {
    case PictureQuality::draft:
      return Quality::draft;
    case PictureQuality::standard:
      return Quality::standard;
    case PictureQuality::high:
      return Quality::high;
    case PictureQuality::automatic:
      break;
  }
  return software_ && pace_.is_slow() && !captured ? Quality::draft : Quality::standard;
}

float Canvas::resolution(PictureQuality wanted, bool captured) {
  const bool fluent_first = software_ && wanted == PictureQuality::automatic && !captured;
  return fluent_first ? pace_.use_resolution(still_) : 1;
}

void Canvas::prune() {
  meshes_.prune();
  renderer_->forget_unused_meshes();
}

}  // namespace tumble
