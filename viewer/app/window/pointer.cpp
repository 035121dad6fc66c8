#include "viewer/app/window/pointer.hpp"

namespace tumble {

void Pointer::move_to(const ViewArea& area) {
  const bool was_beside = is_beside();
  area_ = area;
  if (!tool_.busy())
    origin_ = area_.origin_at(held_.x);
  else
    origin_ = was_beside ? area_.right() : area_.left();
}

bool Pointer::is_taken(std::span<const InputEvent> events, double dt) const {
  if (tool_.busy()) return true;
  HeldInput held = held_;
  for (const InputEvent& event : events) {
    held.apply(event);
    if (!tool_.awaits_second_click(held.x - area_.origin_at(held.x), held.y, dt)) return false;
  }
  return tool_.awaits_second_click(held.x - area_.origin_at(held.x), held.y, dt);
}

PointerEffects Pointer::handle(const std::vector<InputEvent>& for_scene, const HeldInput& before,
                               double dt, const PointedAt& at, CameraController& camera,
                               const ArrangeGestures& arrange, bool keys_are_free) {
  std::vector<InputEvent> events = for_scene;
  bool busy = tool_.busy();
  for (InputEvent& event : events) {
    if (const auto* press = std::get_if<PointerPressed>(&event)) busy = busy || press->down;
    auto* move = std::get_if<PointerMoved>(&event);
    if (!move) continue;
    if (!busy) origin_ = area_.origin_at(move->x);
    move->x -= origin_;
  }
  HeldInput held = before;
  held.x -= origin_;
  const bool beside = is_beside();
  PointerTool::View view;
  view.width = area_.width();
  view.height = area_.height();
  view.keys_are_free = keys_are_free;
  view.pick = [&](const Ray& ray) {
    // The picture of B is empty until B's first frame.
    if (beside && !at.beside) return std::optional<Pick>{};
    const SessionView& seen = beside ? *at.beside : at.shown;
    auto hit = picker_(seen.from, seen.to, seen.s, ray);
    // World B follows A: its bodies can be selected, but not moved.
    if (hit && beside) hit->type = BodyType::fixed;
    return hit;
  };
  if (!beside) {
    view.on_handle = arrange.on_handle;
    view.arranged = arrange.arranged;
  }
  return tool_.handle(events, held, dt, view, camera);
}

void Pointer::choose_look(const UiHost& panels, const SessionView& shown, const Camera& camera) {
  look_ = panels.pointer_look();
  if (panels.wants_pointer() || tool_.busy() || !(held_.x > -1e5) || is_beside()) return;
  const Ray ray = pixel_ray(camera, x(), held_.y, area_.width(), area_.height());
  const auto under = picker_(shown.from, shown.to, shown.s, ray);
  if (under && under->type == BodyType::dynamic) look_ = PointerLook::hand;
}

}  // namespace tumble
