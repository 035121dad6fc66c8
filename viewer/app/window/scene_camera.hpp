#pragma once
#include "viewer/app/scenes/scene_look.hpp"
#include "viewer/app/session/session.hpp"
#include "viewer/interact/camera_controller.hpp"

namespace tumble {

/// The camera of the window: starts as the scene's camera, follows the body that this one follows,
/// and keeps the user's changes.
class SceneCamera {
 public:
  void open(const ViewPoint& view, const Frame& first);
  /// To be called after the same scene was opened anew: keeps the view and the following of a body.
  void go_on_from(const SceneCamera& before);
  CameraController& controller() { return controller_; }
  /// The camera for the whole window.
  const Camera& camera() const { return controller_.camera(); }
  /// The camera for the picture of the world, which may be narrower.
  Camera seen() const { return controller_.seen(); }

  /// Follows the body, or the camera's path, to the moment shown. The path is left when the user
  /// moves the camera, until go_back().
  void carry(const SessionView& shown);
  void stay_above(const Ground& ground);
  /// Returns to the scene's camera as it is at this moment.
  void go_back(const SessionView& shown);
  /// Takes another camera of the scene from now on.
  void look_from(const ViewPoint& view, const SessionView& shown);
  /// Whether the camera follows the path of the scene's camera, or of the one given last.
  bool flying() const { return flying_; }
  /// Stays at the present place.
  void leave_path() { flying_ = false; }
  void frame_all(const Frame& frame, double aspect);
  void frame_body(const Frame& frame, BodyId body, double aspect);

 private:
  void fly(const SessionView& shown);

  CameraController controller_;
  ViewPoint view_;
  Vec3 carried_to_ = Vec3::Zero();  ///< where the camera last followed its body to [m]
  bool flying_ = false;             ///< following the path of the scene's camera
  Camera flown_to_;                 ///< the last camera on that path
  Aabb home_;                       ///< bounds of what was in view when the scene was opened [m]
};

}  // namespace tumble
