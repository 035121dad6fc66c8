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

/// The tools to which drags go while bodies are being arranged; otherwise both null (see
/// PointerTool::View).
struct ArrangeGestures {
  std::function<bool(double x, double y)> on_handle;
  std::function<bool(const Pick&)> arranged;
};

/// What the pointer can hit: the moment shown, and world B's moment in the picture beside it.
struct PointedAt {
  const SessionView& shown;
  const SessionView* beside = nullptr;  ///< null: there is no second picture, or it is still empty
};

/// State of the pointer over the picture: buttons held, the gesture under way, the object below it.
/// A gesture ends in the picture where it began.
class Pointer {
 public:
  /// Sets the positions of the pictures.
  void move_to(const ViewArea& area);
  /// Takes all events of a picture, in order.
  void note(const InputEvent& event) { held_.apply(event); }
  const HeldInput& held() const { return held_; }
  /// x within the picture that the pointer is in; y is held().y.
  double x() const { return held_.x - origin_; }
  /// Whether it is in the picture of world B, where nothing can be changed.
  bool is_beside() const { return area_.places() && origin_ == area_.right(); }
  /// Left edge of the picture that it is in.
  double origin() const { return origin_; }
  const PointerTool& tool() const { return tool_; }
  const MouseDrag& drag() const { return tool_.drag(); }
  PointerLook look() const { return look_; }
  void cancel() { tool_.cancel(); }
  void set_free_flight(bool on) { tool_.set_free_flight(on); }
  void forget_click() { tool_.forget_click(); }
  void set_placing(bool on) { tool_.set_placing(on); }

  /// Whether the panels must ignore the pointer because a gesture in the scene is, or is about to
  /// be, under way.
  bool is_taken(std::span<const InputEvent> events, double dt) const;
  /// The effects of those events that belong to the scene. `before`: what was held before this
  /// picture's events; `keys_are_free`: no text field has the keyboard.
  PointerEffects handle(const std::vector<InputEvent>& for_scene, const HeldInput& before,
                        double dt, const PointedAt& at, CameraController& camera,
                        const ArrangeGestures& arrange, bool keys_are_free);
  /// Sets the cursor's shape: that of the panels, or a hand over what can be dragged.
  void choose_look(const UiHost& panels, const SessionView& shown, const Camera& camera);

 private:
  HeldInput held_;
  ViewArea area_;
  double origin_ = 0;  ///< left edge of the picture that it is in
  PointerTool tool_;
  Picker picker_;
  PointerLook look_ = PointerLook::arrow;
};

}  // namespace tumble
