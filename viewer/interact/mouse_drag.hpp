#pragma once
#include "engine/dynamics/forces/force.hpp"
#include "viewer/interact/picking.hpp"

#include <optional>

namespace tumble {

/// A body held by the pointer: where it was taken, how deep in the picture the pull acts, and the
/// definition of the force that pulls. Knows nothing of worlds; whoever owns one turns `def()` into
/// a force.
class MouseDrag {
 public:
  /// Takes hold of a dynamic body; the pull starts at the point that was hit.
  void begin(const Pick& pick, const Ray& ray, const Camera& camera);
  void end() { held_.reset(); }
  bool active() const { return held_.has_value(); }
  BodyId body() const { return held_ ? held_->body : BodyId{}; }

  /// Moves the target along the plane through it that faces the camera.
  void move(const Ray& ray, const Camera& camera);
  /// Wheel notches: positive pulls nearer to the eye.
  void pull(double notches);

  const Vec3& target() const { return target_; }
  MouseSpringDef def() const;

  /// Angular velocity that a pointer movement of (dx, dy) px within dt seconds gives the body,
  /// about the camera's axes, bounded by one turn a second.
  static Vec3 turning(double dx, double dy, double dt, const Camera& camera);

 private:
  struct Held {
    BodyId body;
    Vec3 point_body;
  };
  std::optional<Held> held_;
  Ray ray_;
  double depth_ = 1;  ///< of the target along the camera's view [m]
  double view_cosine_ = 1;
  Vec3 target_ = Vec3::Zero();
};

}  // namespace tumble
