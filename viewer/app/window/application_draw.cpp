#include "viewer/app/verify/differences.hpp"
#include "viewer/app/window/application.hpp"
#include "viewer/capture/atomic_file.hpp"
#include "viewer/ui/style.hpp"

#include <tuple>

#include <fmt/format.h>

namespace tumble {

/// Draws the contact being inspected, and the handle of the mouse spring (the spring itself is
/// drawn with the scene's forces).
void Application::draw_marks() {
  RenderScene& picture = canvas_.picture();
  if (const ContactView* contact = instruments_.probe.view(); contact && contact->certificate) {
    PointMark ring;
    ring.x = contact->certificate->x_world.cast<float>();
    ring.occlusion = Occlusion::none;
    for (const auto& [size, colour] : {std::pair(18.0f, Vec4f(0.01f, 0.01f, 0.012f, 0.8f)),
                                       std::pair(14.0f, Vec4f(0.1f, 0.8f, 1, 1)),
                                       std::pair(9.0f, Vec4f(0.01f, 0.01f, 0.012f, 1)),
                                       std::pair(6.0f, Vec4f(1, 0.85f, 0.1f, 1))}) {
      ring.size = size;
      ring.colour = colour;
      picture.points.push_back(ring);
    }
  }
  tools_.arranger.draw(world_.frame(), selection_, ui_.handles, handles_view(), pointer_.x(),
                       pointer_.held().y, picture);
  if (ui_.building) tools_.builder.draw(ui_.build, world_.frame(), picture);
  instruments_.ruler.draw(world_.view(), picture);
  draw_emitters();
  if (!pointer_.drag().active()) return;
  PointMark handle;
  handle.x = pointer_.drag().target().cast<float>();
  handle.occlusion = Occlusion::none;
  handle.size = 15;
  handle.colour = Vec4f(0.01f, 0.01f, 0.012f, 0.75f);
  picture.points.push_back(handle);
  handle.size = 10;
  handle.colour = Vec4f(0.9f, 0.33f, 0.07f, 1);
  picture.points.push_back(handle);
}

ExtractOptions Application::extract_options() const {
  ExtractOptions options;
  options.overlays = ui_.overlays;
  options.before = world_.view().before;
  options.selected = selection_.main();
  options.also_selected = selection_.all();
  options.notes = scene_.notes;
  options.microscope = instruments_.microscope.setup(ui_.microscope);
  options.microscope_step = ui_.microscope.step;
  options.microscope_said =
      recording() ? world_.recorder().said() : instruments_.microscope_probe.said();
  options.world_hierarchy = settings_.value().hierarchy;
  return options;
}

bool Application::stands_beside() const {
  return ui_.compared_as == ComparedAs::beside && second_.comparison();
}

/// Titles the pictures of world A and world B.
void Application::name_pictures(RenderScene& a, RenderScene& b) const {
  const auto& [of_a, of_b] = names_by(second_.comparison()->differences);
  constexpr float below_bar = 60, at_top = 14;  // [UI units]
  for (const auto& [picture, letter, words] :
       {std::tuple(&a, "A", &of_a), std::tuple(&b, "B", &of_b)}) {
    TextLabel label;
    label.text = words->empty() ? letter : fmt::format("{}: {}", letter, *words);
    label.in_world = false;
    label.x = Vec3f(14, ui_.hidden ? at_top : below_bar, 0) * float(layout_.size.scale);
    label.size = 17;
    picture->texts.push_back(std::move(label));
  }
}

/// Sets the camera of the picture or pictures.
void Application::look_from(const ViewArea& area) {
  canvas_.picture().camera = area.seen_by(camera_.camera());
  if (stands_beside()) second_.look_from(canvas_.picture().camera);
}

/// Draws the picture of A, or the pictures of both, with panels over them.
Status Application::draw_pictures(UiDrawList& panels, const ViewArea& area, int width, int height) {
  if (!area.places() || !stands_beside()) return canvas_.draw(panels, width, height);
  SideBySide places = *area.places();
  if (!panels.draws.empty()) places.around = palette::components(palette::backdrop);
  return canvas_.draw_beside(second_.picture(), places, panels, width, height);
}

Status Application::draw_sequence(Recorder& recorder) {
  // A recorded sequence shows the scene without panels, and keeps its size when the window changes.
  UiDrawList no_panels;
  canvas_.picture().legend_area.reset();
  PictureLayout layout;
  layout.size = {recorder.width(), recorder.height(), 1};
  const ViewArea area = layout.area_in(layout.all(), stands_beside());
  look_from(area);
  Status s = draw_pictures(no_panels, area, recorder.width(), recorder.height());
  if (s) s = recorder.add(canvas_.renderer(), canvas_.picture().camera, report().draws.hash);
  look_from(layout_.area);
  return s;
}

Status Application::draw() {
  canvas_.compose(world_.view(), extract_options(), layout_.area.seen_by(camera_.camera()));
  if (ui_.compared_as == ComparedAs::ghost)
    second_.draw_ghost(world_.view(), extract_options(), canvas_.meshes(), canvas_.picture());
  draw_marks();
  RenderScene& picture = canvas_.picture();
  // Screenshots and recordings are not drafts, nor are pictures that must be reproducible.
  const bool best = screenshots_.wanted() || recording() || !options_.own_thread;
  picture.quality = canvas_.quality(ui_.quality, best);
  picture.resolution = canvas_.resolution(ui_.quality, best);
  picture.ui_scale = float(layout_.size.scale);
  if (stands_beside())
    name_pictures(picture,
                  second_.draw_beside(world_.view(), extract_options(), canvas_.meshes(), picture));
  if (Recorder& recorder = world_.recorder(); recorder.ready())
    if (const Status s = draw_sequence(recorder); !s) {
      (void)recorder.stop(session());
      ui_.toast(ToastKind::error, "The sequence has ended", {s.error().text()});
    }
  // The panel has the same text as the plate.
  if (ui_.shows(PanelId::microscope) && !ui_.hidden && !screenshots_.wants_plain())
    picture.plate.reset();
  if (picture.plate && !layout_.panels.draws.empty() && !ui_.hidden)
    picture.plate->top = layout_.pixels(layout_.free_area.y);
  picture.legend_area.reset();
  if (!layout_.panels.draws.empty() && !layout_.area.places()) {
    const UiRect& free = layout_.free_area;
    picture.legend_area = {layout_.pixels(free.x), layout_.pixels(free.y),
                           layout_.pixels(free.x + free.width),
                           layout_.pixels(free.y + free.height)};
  }
  return without_broken_shaders(
      draw_pictures(layout_.panels, layout_.area, layout_.size.width, layout_.size.height));
}

void Application::next_comparison_view() {
  using enum ComparedAs;
  if (!second_.comparison()) {
    ui_.shows(PanelId::compare) = true;
    return ui_.toast(ToastKind::info,
                     "Nothing is compared yet: Start in the panel Compare begins with it");
  }
  ui_.compared_as = ui_.compared_as == ghost ? beside : ui_.compared_as == beside ? hidden : ghost;
}

/// A shader that fails to link when it is first used, in the middle of a session, must not close
/// the window: the picture is drawn without it. It is an error in the first picture, and where
/// there is no user.
Status Application::without_broken_shaders(Status drawn) {
  if (drawn || drawn.error().code != ErrorCode::parse) return drawn;
  if (!options_.own_thread || canvas_.pace().pictures() <= 1) return drawn;
  if (broken_shaders_.insert(drawn.error().place).second)
    ui_.toast(ToastKind::error, "Something cannot be drawn, and is missing from the picture",
              {drawn.error().text()});
  return {};
}

Recording Application::new_recording() const {
  return {options_.capture_folder, scene_.name,         canvas_.renderer_name(), options_.version,
          layout_.size.width,      layout_.size.height, options_.own_thread};
}

void Application::save_screenshot() {
  const auto saved = screenshots_.save(canvas_.renderer(), scene_.name);
  if (saved)
    ui_.toast(ToastKind::info, "Screenshot " + saved->filename().string());
  else
    ui_.toast(ToastKind::error, "The picture cannot be written", {saved.error().text()});
}

void Application::write_measures() {
  const auto file = options_.capture_folder / (scene_.name + "_measures.csv");
  Status done = make_folder(options_.capture_folder);
  if (done) done = write_file(file, std::string_view(instruments_.measures.csv()));
  if (!done)
    return ui_.toast(ToastKind::error, "The curves cannot be written", {done.error().text()});
  ui_.toast(ToastKind::info, "Written to " + file.string());
}

/// A screenshot without panels is a picture of its own, drawn before the one shown. Two pictures
/// beside each other then also use the room of the panels.
void Application::save_plain_screenshot() {
  UiDrawList panels;
  std::swap(panels, layout_.panels);
  const ViewArea shown = layout_.area;
  if (layout_.area.places()) layout_.area = layout_.area_in(layout_.all(), true);
  const Status drawn = draw();
  layout_.area = shown;
  std::swap(panels, layout_.panels);
  (void)screenshots_.take(false);
  if (drawn)
    save_screenshot();
  else
    ui_.toast(ToastKind::error, "The picture cannot be written", {drawn.error().text()});
}

}  // namespace tumble
