#pragma once
#include "viewer/app/session/session.hpp"
#include "viewer/app/window/view_area.hpp"
#include "viewer/interact/picking.hpp"
#include "viewer/interact/pointer_tool.hpp"
#include "viewer/ui/ui_host.hpp"

#include <functional>
#include <span>
#include <vector>

namespace tumble {

/// Which drags arrange bodies: both null while none does (see PointerTool::View).
struct ArrangeGestures {
  std::function<bool(double x, double y)> on_handle;
  std::function<bool(const Pick&)> arranged;
};

/// What the pointer can be on: the moment that the picture shows, and beside it that of world B.
struct PointedAt {
  const SessionView& shown;
  const SessionView* beside = nullptr;  ///< null: there is no second picture, or nothing in it yet
};

/// The pointer over the picture: what is held down, the gesture that is under way, what it is on.
/// A gesture ends in the picture where it began.
class Pointer {
 public:
  /// Where the pictures are from now on.
  void move_to(const ViewArea& area);
  /// Events of a picture, all of them, in order.
  void note(const InputEvent& event) { held_.apply(event); }
  const HeldInput& held() const { return held_; }
  /// Across the picture that it is in; held().y is down it.
  double x() const { return held_.x - origin_; }
  /// On the picture of world B, which is looked at only.
  bool is_beside() const { return area_.places() && origin_ == area_.right(); }
  /// Left edge of the picture it is in.
  double origin() const { return origin_; }
  const PointerTool& tool() const { return tool_; }
  const MouseDrag& drag() const { return tool_.drag(); }
  PointerLook look() const { return look_; }
  void cancel() { tool_.cancel(); }
  void set_free_flight(bool on) { tool_.set_free_flight(on); }
  void forget_click() { tool_.forget_click(); }
  void set_placing(bool on) { tool_.set_placing(on); }

  /// Whether the panels must not see the pointer: it is busy with the scene, or about to be.
  bool is_taken(std::span<const InputEvent> events, double dt) const;
  /// What the events that are the scene's ask for; `before`: what was held before the picture's;
  /// `keys_are_free`: nobody is typing.
  PointerEffects handle(const std::vector<InputEvent>& for_scene, const HeldInput& before,
                        double dt, const PointedAt& at, CameraController& camera,
                        const ArrangeGestures& arrange, bool keys_are_free);
  /// Chooses the pointer's look: that of the panels, a hand over what can be dragged.
  void choose_look(const UiHost& panels, const SessionView& shown, const Camera& camera);

 private:
  HeldInput held_;
  ViewArea area_;
  double origin_ = 0;  ///< of the picture that it is in
  PointerTool tool_;
  Picker picker_;
  PointerLook look_ = PointerLook::arrow;
};

}  // namespace tumble
