#include "viewer/app/pointer.hpp"

namespace tumble {

bool Pointer::is_taken(std::span<const InputEvent> events, double dt) const {
  if (tool_.busy()) return true;
  HeldInput held = held_;
  for (const InputEvent& event : events) {
    held.apply(event);
    if (!tool_.awaits_second_click(held.x, held.y, dt)) return false;
  }
  return tool_.awaits_second_click(held.x, held.y, dt);
}

PointerEffects Pointer::handle(const std::vector<InputEvent>& for_scene, const HeldInput& before,
                               double dt, double width, double height, const SessionView& shown,
                               CameraController& camera, const ArrangeGestures& arrange) {
  PointerTool::View view;
  view.width = width;
  view.height = height;
  view.pick = [&](const Ray& ray) { return picker_(shown.from, shown.to, shown.s, ray); };
  view.on_handle = arrange.on_handle;
  view.arranged = arrange.arranged;
  return tool_.handle(for_scene, before, dt, view, camera);
}

void Pointer::choose_look(const UiHost& panels, double width, double height,
                          const SessionView& shown, const Camera& camera) {
  look_ = panels.pointer_look();
  if (panels.wants_pointer() || tool_.busy() || !(held_.x > -1e5)) return;
  const Ray ray = pixel_ray(camera, held_.x, held_.y, width, height);
  const auto under = picker_(shown.from, shown.to, shown.s, ray);
  if (under && under->type == BodyType::dynamic) look_ = PointerLook::hand;
}

}  // namespace tumble
