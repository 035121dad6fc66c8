#include "viewer/app/window/scene_camera.hpp"

#include "viewer/interact/picking.hpp"

namespace tumble {

void SceneCamera::open(const ViewPoint& view, const Frame& first) {
  view_ = view;
  controller_.set(view.camera);
  carried_to_ = view.camera.target;
  home_ = interesting_bounds(first);
  flying_ = !view.path.empty();
  flown_to_ = camera();
}

void SceneCamera::go_on_from(const SceneCamera& before) {
  controller_ = before.controller_;
  // The camera has already moved by this much with its body; the rest follows with the next frame.
  if (!before.view_.follow.is_null()) carried_to_ = before.carried_to_;
  flying_ = flying_ && before.flying_;
  flown_to_ = camera();
}

void SceneCamera::carry(const SessionView& shown) {
  if (!view_.path.empty()) return fly(shown);
  if (!find_slot(*shown.to, view_.follow)) return;
  const Vec3 target = view_.at(*shown.from, *shown.to, shown.s).target;
  controller_.carry(target - carried_to_);
  carried_to_ = target;
}

void SceneCamera::fly(const SessionView& shown) {
  const Camera& now = camera();
  flying_ = flying_ && now.eye == flown_to_.eye && now.target == flown_to_.target;
  if (!flying_) return;
  controller_.set(view_.at(*shown.from, *shown.to, shown.s));
  flown_to_ = camera();
}

void SceneCamera::stay_above(const Ground& ground) {
  controller_.set_floor(ground.visible ? std::optional(ground.height) : std::nullopt);
}

void SceneCamera::go_back(const SessionView& shown) {
  const Camera there = view_.at(*shown.from, *shown.to, shown.s);
  flying_ = !view_.path.empty();
  if (!flying_) return controller_.go_to(there);
  controller_.set(there);
  flown_to_ = camera();
}

void SceneCamera::look_from(const ViewPoint& view, const SessionView& shown) {
  view_ = view;
  carried_to_ = view_.at(*shown.from, *shown.to, shown.s).target;
  go_back(shown);
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
