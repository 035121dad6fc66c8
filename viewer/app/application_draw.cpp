#include "viewer/app/application.hpp"
#include "viewer/app/application_state.hpp"
#include "viewer/capture/atomic_file.hpp"
#include "viewer/capture/png.hpp"

#include <fmt/format.h>

namespace tumble {
namespace {

/// The first name FOLDER/STEM-000.png that does not exist yet.
std::filesystem::path free_name(const std::filesystem::path& folder, const std::string& stem) {
  std::error_code ignored;
  for (int i = 0;; ++i) {
    const std::filesystem::path path = folder / fmt::format("{}-{:03}.png", stem, i);
    if (i > 99999 || !std::filesystem::exists(path, ignored)) return path;
  }
}

}  // namespace

/// The contact that is looked at, and what the mouse holds: the spring itself is drawn with the
/// scene's forces, its handle here.
void Application::draw_marks() {
  if (const ContactView* contact = probe_.view(); contact && contact->certificate) {
    PointMark ring;
    ring.x = contact->certificate->x_world.cast<float>();
    ring.occlusion = Occlusion::none;
    for (const auto& [size, colour] : {std::pair(18.0f, Vec4f(0.01f, 0.01f, 0.012f, 0.8f)),
                                       std::pair(14.0f, Vec4f(0.1f, 0.8f, 1, 1)),
                                       std::pair(9.0f, Vec4f(0.01f, 0.01f, 0.012f, 1)),
                                       std::pair(6.0f, Vec4f(1, 0.85f, 0.1f, 1))}) {
      ring.size = size;
      ring.colour = colour;
      render_scene_.points.push_back(ring);
    }
  }
  if (!pointer_.drag().active()) return;
  PointMark handle;
  handle.x = pointer_.drag().target().cast<float>();
  handle.occlusion = Occlusion::none;
  handle.size = 15;
  handle.colour = Vec4f(0.01f, 0.01f, 0.012f, 0.75f);
  render_scene_.points.push_back(handle);
  handle.size = 10;
  handle.colour = Vec4f(0.9f, 0.33f, 0.07f, 1);
  render_scene_.points.push_back(handle);
}

/// Automatic: standard, and a draft once a software renderer has been slow for a while. Captured
/// pictures are never drafts, and neither is anything where the same input must give the same bits.
Quality Application::picture_quality() {
  switch (ui_.quality) {
    case PictureQuality::draft:
      return Quality::draft;
    case PictureQuality::standard:
      return Quality::standard;
    case PictureQuality::high:
      return Quality::high;
    case PictureQuality::automatic:
      break;
  }
  constexpr double fluent = 0.05;  // [s]
  constexpr int patience = 20;
  if (slow_pictures_ < patience)
    slow_pictures_ = drawing_seconds_ > fluent ? slow_pictures_ + 1 : 0;
  const bool captured = want_screenshot_ || want_plain_screenshot_ || recorder_.active();
  const bool draft = software_ && options_.own_thread && slow_pictures_ >= patience && !captured;
  return draft ? Quality::draft : Quality::standard;
}

ExtractOptions Application::extract_options() const {
  ExtractOptions options;
  options.overlays = ui_.overlays;
  options.selected = selected_;
  options.notes = scene_.notes;
  options.microscope = scene_.microscope;
  if (options.microscope && !ui_.microscope.algorithm.empty())
    options.microscope->algorithm = ui_.microscope.algorithm;
  options.microscope_step = ui_.microscope.step;
  std::lock_guard lock(settings_->mutex);
  options.world_hierarchy = settings_->value.hierarchy;
  return options;
}

Status Application::draw(const Picture& picture) {
  const ExtractOptions options = extract_options();
  extract(*view_.from, *view_.to, view_.s, options, meshes_, render_scene_);
  draw_marks();
  render_scene_.camera = camera_.camera();
  render_scene_.quality = picture_quality();
  render_scene_.ui_scale = float(picture.scale);
  if (recorder_.ready()) {
    // A sequence shows the scene, not the panels, and keeps its size when the window changes.
    render_scene_.ui = UiDrawList{};
    auto drawn = renderer_->render(render_scene_, recorder_.width(), recorder_.height());
    if (!drawn) return drawn.error();
    if (Status s = recorder_.add(*renderer_, render_scene_.camera, drawn->draws.hash); !s) {
      (void)recorder_.stop(*session_);
      ui_.toast(ToastKind::error, "The sequence has ended", {s.error().text()});
    }
  }
  // The panel says what the plate says.
  if (ui_.shows(PanelId::microscope) && !ui_.hidden && !want_plain_screenshot_)
    render_scene_.plate.reset();
  render_scene_.ui = std::move(ui_list_);
  auto report = renderer_->render(render_scene_, picture.width, picture.height);
  ui_list_ = std::move(render_scene_.ui);
  if (!report) return report.error();
  report_ = *report;
  return {};
}

Recording Application::new_recording() const {
  return {options_.capture_folder, scene_.name, renderer_name_, options_.version, width_, height_,
          options_.own_thread};
}

Status Application::save_picture() {
  if (Status s = make_folder(options_.capture_folder); !s) return s;
  Image image;
  if (Status s = renderer_->read_back(image); !s) return s;
  const std::filesystem::path path =
      free_name(options_.capture_folder, "tumble-" + (scene_.name.empty() ? "scene" : scene_.name));
  if (Status s = write_png(path, without_alpha(image)); !s) return s;
  captured_.push_back(path);
  ui_.toast(ToastKind::info, "Screenshot " + path.filename().string());
  return {};
}

/// The screenshot without panels is a picture of its own, drawn before the one that is shown.
Status Application::take_screenshots(const Picture& picture) {
  if (!want_plain_screenshot_) return {};
  UiDrawList panels;
  std::swap(panels, ui_list_);
  const Status drawn = draw(picture);
  want_plain_screenshot_ = false;
  std::swap(panels, ui_list_);
  if (!drawn) return drawn;
  return save_picture();
}

}  // namespace tumble
