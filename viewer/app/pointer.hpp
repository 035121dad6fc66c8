#pragma once
#include "viewer/app/session.hpp"
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

/// The pointer over the picture: what is held down, the gesture that is under way, what it is on.
class Pointer {
 public:
  /// Events of a picture, all of them, in order.
  void note(const InputEvent& event) { held_.apply(event); }
  const HeldInput& held() const { return held_; }
  const PointerTool& tool() const { return tool_; }
  const MouseDrag& drag() const { return tool_.drag(); }
  PointerLook look() const { return look_; }
  void cancel() { tool_.cancel(); }

  /// Whether the panels must not see the pointer: it is busy with the scene, or about to be.
  bool is_taken(std::span<const InputEvent> events, double dt) const;
  /// What the events that are the scene's ask for; `before`: what was held before the picture's.
  PointerEffects handle(const std::vector<InputEvent>& for_scene, const HeldInput& before,
                        double dt, double width, double height, const SessionView& shown,
                        CameraController& camera, const ArrangeGestures& arrange);
  /// Chooses the pointer's look: that of the panels, a hand over what can be dragged.
  void choose_look(const UiHost& panels, double width, double height, const SessionView& shown,
                   const Camera& camera);

 private:
  HeldInput held_;
  PointerTool tool_;
  Picker picker_;
  PointerLook look_ = PointerLook::arrow;
};

}  // namespace tumble
