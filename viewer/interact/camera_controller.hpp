#pragma once
#include "viewer/render/camera.hpp"

#include <optional>

namespace tumble {

/// A camera that turns about a pivot with y up, pans, zooms and flies. Changes go to a goal that
/// the picture's camera follows within a fifth of a second, independent of the frame rate. Lengths
/// in metres, pixels in UI units.
class CameraController {
 public:
  CameraController() { set(Camera{}); }

  /// Takes over a camera at once (a scene was loaded).
  void set(const Camera& camera);
  const Camera& camera() const { return camera_; }
  /// The picture is narrower than the window: it shows as much from left to right, and this many
  /// times as much from top to bottom (see heightened()).
  void set_heightening(double ratio) { heightening_ = ratio; }
  /// That of such a picture: rays through its pixels are this one's.
  Camera seen() const { return heightened(camera_, heightening_); }
  const Vec3& pivot() const { return goal_.pivot; }

  /// What a person does keeps the eye above this height [m], unless it is below already; none:
  /// everywhere.
  void set_floor(std::optional<double> height);
  /// Goes to a camera, as if a person had moved there.
  void go_to(const Camera& camera);

  /// Turns about the pivot by a drag; a full turn takes about 1200 px.
  void orbit(double dx, double dy);
  /// Moves along the picture, so that the pivot's plane follows the pointer.
  void pan(double dx, double dy, double view_height);
  /// Wheel notches, positive nearer.
  void zoom(double notches);
  /// Turns about the eye by a drag.
  void look(double dx, double dy);
  /// Moves the eye along the camera's right, world up and the view, in units of its own speed.
  void fly(const Vec3& right_up_forward, double dt, bool fast);
  /// Moves everything along at once, as with a body that the camera follows.
  void carry(const Vec3& shift);
  /// Makes a point the pivot and looks at it, from where the camera is.
  void focus(const Vec3& point);
  /// Shows all of `bounds` from the present direction.
  void focus(const Aabb& bounds, double aspect);

  /// Lets the camera follow its goal for dt seconds.
  void update(double dt);
  /// Jumps to the goal (tests, screenshots).
  void arrive();

 private:
  struct View {
    Vec3 pivot = Vec3::Zero();
    double yaw = 0;    ///< [rad] 0: the eye is on +z of the pivot; positive: towards +x
    double pitch = 0;  ///< [rad] positive: the eye is above
    double distance = 10;
  };
  static Vec3 to_eye(const View& view);
  void publish();
  void aim(const Camera& camera);
  void keep_proper();
  void stay_above_floor();

  View goal_, now_;
  std::optional<double> floor_;
  double fov_deg_ = 40;
  double heightening_ = 1;
  double near_ = 0, far_ = 0;
  Camera camera_;
};

}  // namespace tumble
