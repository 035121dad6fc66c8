#pragma once
#include "viewer/app/scenes/scene_look.hpp"
#include "viewer/app/session/session.hpp"
#include "viewer/interact/camera_controller.hpp"

namespace tumble {

/// The camera of the window: begins as the scene's, goes along with the body that this follows, and
/// keeps what a person does to it.
class SceneCamera {
 public:
  void open(const ViewPoint& view, const Frame& first);
  /// The same scene was opened anew: one goes on looking from where one was before, and going
  /// along.
  void go_on_from(const SceneCamera& before);
  CameraController& controller() { return controller_; }
  /// Of the whole window.
  const Camera& camera() const { return controller_.camera(); }
  /// Of the picture of the world, which may be narrower.
  Camera seen() const { return controller_.seen(); }

  /// Goes along with the followed body, or on along its path, to the moment that is shown; off
  /// the path once a person has moved it, until go_back().
  void carry(const SessionView& shown);
  void stay_above(const Ground& ground);
  /// The scene's camera, as it is at this moment.
  void go_back(const SessionView& shown);
  /// Another camera of the scene, from now on.
  void look_from(const ViewPoint& view, const SessionView& shown);
  /// On the path of the scene's camera, or of the one given last.
  bool flying() const { return flying_; }
  /// Stays where it is.
  void leave_path() { flying_ = false; }
  void frame_all(const Frame& frame, double aspect);
  void frame_body(const Frame& frame, BodyId body, double aspect);

 private:
  void fly(const SessionView& shown);

  CameraController controller_;
  ViewPoint view_;
  Vec3 carried_to_ = Vec3::Zero();  ///< where the followed camera looked last [m]
  bool flying_ = false;             ///< on the path of the scene's camera
  Camera flown_to_;                 ///< there
  Aabb home_;                       ///< what was to be seen when the scene was opened [m]
};

}  // namespace tumble
