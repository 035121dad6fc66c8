#pragma once
#include "viewer/render/camera.hpp"

#include <optional>

namespace tumble {

/// A camera that orbits a pivot with y up, pans, zooms and flies. Changes apply to a goal, which
/// the drawn camera approaches within a fifth of a second, independently of the frame rate. Lengths
/// in metres, pixels in UI units.
class CameraController {
 public:
  CameraController() { set(Camera{}); }

  /// Sets the camera without a transition (for another scene).
  void set(const Camera& camera);
  const Camera& camera() const { return camera_; }
  /// For a picture narrower than the window that shows the same width of the scene: the ratio of
  /// its height of view to that of the window (see heightened()).
  void set_heightening(double ratio) { heightening_ = ratio; }
  /// The camera of such a picture, for rays through its pixels.
  Camera seen() const { return heightened(camera_, heightening_); }
  const Vec3& pivot() const { return goal_.pivot; }

  /// Sets the height [m] below which the user's changes do not move the eye, unless it is below
  /// already; none: no limit.
  void set_floor(std::optional<double> height);
  /// Moves to a camera with a transition, as if the user had moved there.
  void go_to(const Camera& camera);

  /// Orbits the pivot by a drag [px]; a full turn takes about 1200 px.
  void orbit(double dx, double dy);
  /// Pans by a drag [px], so that the plane through the pivot follows the pointer.
  void pan(double dx, double dy, double view_height);
  /// Zooms by notches of the wheel; positive moves nearer.
  void zoom(double notches);
  /// Rotates the view about the eye by a drag [px].
  void look(double dx, double dy);
  /// Moves the eye along the camera's right, the world's up, and the view direction, as multiples
  /// of its speed, for `dt` [s].
  void fly(const Vec3& right_up_forward, double dt, bool fast);
  /// Shifts the camera without a transition, e.g. with a body that it follows [m].
  void carry(const Vec3& shift);
  /// Makes a point the pivot and looks at it from the present place.
  void focus(const Vec3& point);
  /// Shows all of `bounds` from the present direction.
  void focus(const Aabb& bounds, double aspect);

  /// Lets the camera approach its goal for `dt` [s].
  void update(double dt);
  /// Moves the camera to its goal at once (tests, screenshots).
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
