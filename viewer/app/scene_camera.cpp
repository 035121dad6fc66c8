#include "viewer/app/scene_camera.hpp"

#include "viewer/interact/picking.hpp"

namespace tumble {

void SceneCamera::open(const ViewPoint& view, const Frame& first) {
  view_ = view;
  controller_.set(view.camera);
  carried_to_ = view.camera.target;
  home_ = interesting_bounds(first);
}

void SceneCamera::carry(const SessionView& shown) {
  if (!find_slot(*shown.to, view_.follow)) return;
  const Vec3 target = view_.at(*shown.from, *shown.to, shown.s).target;
  controller_.carry(target - carried_to_);
  carried_to_ = target;
}

void SceneCamera::stay_above(const Ground& ground) {
  controller_.set_floor(ground.visible ? std::optional(ground.height) : std::nullopt);
}

void SceneCamera::go_back(const SessionView& shown) {
  controller_.go_to(view_.at(*shown.from, *shown.to, shown.s));
}

void SceneCamera::frame_all(const Frame& frame, double aspect) {
  controller_.focus(interesting_bounds(frame, home_), aspect);
}

void SceneCamera::frame_body(const Frame& frame, BodyId body, double aspect) {
  const auto slot = find_slot(frame, body);
  if (!slot) return;
  const Aabb bounds = body_bounds(frame, *slot);
  if (!bounds.empty()) controller_.focus(bounds.inflated(bounds.extent().norm()), aspect);
}

}  // namespace tumble
