// Selection, handles and clipboard.
#include "engine/math/rotation.hpp"
#include "viewer/app/window/application.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace tumble {
namespace {

std::string undo_step_of(HandleKind kind) {
  switch (kind) {
    case HandleKind::turn:
      return "Turn ";
    case HandleKind::scale:
      return "Scale ";
    default:
      return "Move ";
  }
}

}  // namespace

Handles::View Application::handles_view() const {
  return {camera_.seen(), layout_.area.width(), layout_.area.height()};
}

/// Where scripts grab a handle: "x", "across_y", "middle".
std::optional<Vec3> Application::handle_grip(std::string_view name) const {
  using enum Handles::Part;
  constexpr std::pair<std::string_view, Handles::Part> parts[] = {{"x", x},
                                                                  {"y", y},
                                                                  {"z", z},
                                                                  {"across_x", across_x},
                                                                  {"across_y", across_y},
                                                                  {"across_z", across_z},
                                                                  {"middle", middle}};
  const auto frame = Arranger::frame_of(world_.frame(), selection_, ui_.handles);
  if (!frame || ui_.handles.kind == HandleKind::none) return std::nullopt;
  for (const auto& [known, part] : parts)
    if (known == name) return Handles::grip(ui_.handles.kind, *frame, part, handles_view());
  return std::nullopt;
}

/// A second press of the same key hides them.
void Application::show_handles(HandleKind kind) {
  ui_.handles.kind = ui_.handles.kind == kind ? HandleKind::none : kind;
  if (ui_.handles.kind == HandleKind::none) return;
  ui_.building = false;
  tools_.builder.cancel();
  if (selection_.empty()) ui_.toast(ToastKind::info, "Click a body to see its handles");
}

ArrangeGestures Application::gestures() const {
  if (ui_.handles.kind == HandleKind::none) return {};
  return {[this](double x, double y) {
            const auto frame = Arranger::frame_of(world_.frame(), selection_, ui_.handles);
            return frame && Handles::hit(ui_.handles.kind, *frame, handles_view(), x, y) !=
                                Handles::Part::none;
          },
          // Fixed bodies are mostly used as ground: they can be dragged only if they are selected.
          [this](const Pick& pick) {
            return pick.type == BodyType::dynamic || selection_.contains(pick.body);
          }};
}

void Application::arrange(const PointerEffects& effects) {
  if (effects.arrange_began)
    tools_.arranger.begin(world_.frame(), selection_, ui_.handles, handles_view(), effects.press_x,
                          effects.press_y, effects.on_handle);
  if (effects.arrange_moved && tools_.arranger.active()) arrange_to(effects.x, effects.y);
  if (effects.arrange_ended) end_arranging();
}

/// A paused drag that ends where it began is no undo step.
void Application::end_arranging() {
  const auto& last = tools_.arranger.last();
  if (session().paused() && last && last->is_null()) undo_steps_.leave_newest(session());
  tools_.arranger.end();
}

/// How far away bodies are put by pointing: a pointer near the horizon means a place that is out of
/// sight, and not that far away [m].
double Application::placing_reach() const {
  constexpr double views = 2.5;  // viewing distances
  const Camera& camera = camera_.seen();
  return views * (camera.target - camera.eye).norm();
}

void Application::arrange_to(double x, double y) {
  const Handles::View view = handles_view();
  const bool snap = ui_.handles.snap != pointer_.held().key(Key::control);
  const SessionView& shown = world_.view();
  const auto hit =
      pick(*shown.from, *shown.to, shown.s, pixel_ray(view.camera, x, y, view.width, view.height),
           std::max(placing_reach(), tools_.arranger.distance_from(view.camera.eye)),
           tools_.arranger.bodies());
  const auto way = tools_.arranger.drag(ui_.handles, view, x, y, snap, hit);
  if (!way || !tools_.arranger.last()) return;
  const UndoStepEdits edits = begin_edit(undo_step_of(ui_.handles.kind) + selected_names(), true);
  tools_.arranger.apply(session(), *way, edits, tools_.refusal);
}

/// While the simulation runs, gravity would move the dragged bodies between two moves of the
/// pointer.
void Application::hold_arranged() {
  if (session().paused() || !tools_.arranger.last() || undo_steps_.edits().empty()) return;
  tools_.arranger.apply(session(), *tools_.arranger.last(), undo_steps_.edits().newest(),
                        tools_.refusal);
}

void Application::displace_selected(const Displacement& way) {
  const auto frame = Arranger::frame_of(world_.frame(), selection_, ui_.handles);
  if (!frame) return ui_.toast(ToastKind::info, "Select a body first");
  if (way.is_null()) return;
  Displacement about = way;
  about.pivot = frame->x;
  about.shift = frame->direction(way.shift);
  about.turn = frame->q * way.turn * frame->q.conjugate();
  const UndoStepEdits edits = begin_edit(undo_step_of(ui_.handles.kind) + selected_names());
  Arranger::apply_once(session(), selection_, about, edits, tools_.refusal);
}

void Application::copy_selected() {
  if (selection_.empty()) return ui_.toast(ToastKind::info, "Select a body to copy it");
  tools_.clipboard.copy(session(), selection_, scene_.file.path.string());
  ui_.toast(ToastKind::info,
            fmt::format("Copied {}: {} pastes", selected_names(), shortcut_of(Action::paste)));
}

/// Pastes onto what is under the pointer; if that is a panel, nothing or too far away, in front of
/// the camera.
void Application::paste() {
  if (tools_.clipboard.empty())
    return ui_.toast(ToastKind::info, fmt::format("Nothing was copied: {} copies what is selected",
                                                  shortcut_of(Action::copy)));
  const Handles::View view = handles_view();
  const bool on_scene = pointer_.held().x > -1e5 && !host_.wants_pointer();
  const double x = on_scene ? pointer_.x() : 0.5 * view.width;
  const double y = on_scene ? pointer_.held().y : 0.5 * view.height;
  const Ray ray = pixel_ray(view.camera, x, y, view.width, view.height);
  const SessionView& shown = world_.view();
  const auto hit = pick(*shown.from, *shown.to, shown.s, ray, placing_reach());
  PastePlace place;
  place.x =
      hit ? hit->x_world
          : ray.origin + (view.camera.target - view.camera.eye).norm() * ray.direction.normalized();
  if (hit) place.normal = hit->normal;
  const UndoStepEdits edits = begin_edit(
      tools_.clipboard.count() == 1 ? "Paste a body"
                                    : fmt::format("Paste {} bodies", tools_.clipboard.count()));
  tools_.duplicator.await(
      tools_.clipboard.paste(session(), scene_.file.path.string(), place, edits, tools_.refusal));
  tools_.parts.name_springs(session(), edits);
  tools_.parts.note();
}

void Application::select_all() {
  selection_.clear();
  const Frame& frame = world_.frame();
  for (size_t slot = 0; slot < frame.body_slots(); ++slot)
    if (!frame.body(slot).id.is_null() && frame.info(slot).type == BodyType::dynamic)
      selection_.add(frame.body(slot).id);
}

/// Adds to the selection all movable bodies whose centres are in the box.
void Application::select_box(const PointerBox& box) {
  tools_.box = box;
  if (!box.done) return;
  tools_.box.reset();
  const auto [left, right] = std::minmax(box.x0, box.x1);
  const auto [top, bottom] = std::minmax(box.y0, box.y1);
  const Handles::View view = handles_view();
  const SessionView& shown = world_.view();
  const Frame& frame = *shown.to;
  for (size_t slot = 0; slot < frame.body_slots(); ++slot) {
    const BodyFrame& body = frame.body(slot);
    if (body.id.is_null() || frame.info(slot).type != BodyType::dynamic ||
        !frame.info(slot).look.visible)
      continue;
    const Vec3 at = project(view.camera, interpolated_pose(*shown.from, frame, slot, shown.s).x,
                            view.width, view.height);
    if (at.z() > 0 && at.x() >= left && at.x() <= right && at.y() >= top && at.y() <= bottom)
      selection_.add(body.id);
  }
}

}  // namespace tumble
