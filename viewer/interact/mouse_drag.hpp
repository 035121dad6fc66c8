#pragma once
#include "engine/dynamics/forces/force.hpp"
#include "viewer/interact/picking.hpp"

#include <optional>

namespace tumble {

/// A body held by the pointer: the point where it was grabbed, the depth at which the target moves,
/// and the definition of the force that pulls. Independent of worlds; the owner creates a force
/// from `def()`.
class MouseDrag {
 public:
  /// Grabs a dynamic body at the point that was hit.
  void begin(const Pick& pick, const Ray& ray, const Camera& camera);
  void end() { held_.reset(); }
  bool active() const { return held_.has_value(); }
  BodyId body() const { return held_ ? held_->body : BodyId{}; }

  /// Moves the target in the plane through it that is parallel to the picture.
  void move(const Ray& ray, const Camera& camera);
  /// Changes the depth by notches of the wheel: positive pulls nearer to the eye.
  void pull(double notches);

  const Vec3& target() const { return target_; }
  MouseSpringDef def() const;

  /// Angular velocity about the camera's axes that corresponds to a pointer movement of (dx, dy) px
  /// within dt seconds, bounded by one turn per second.
  static Vec3 turning(double dx, double dy, double dt, const Camera& camera);

 private:
  struct Held {
    BodyId body;
    Vec3 point_body;
  };
  std::optional<Held> held_;
  Ray ray_;
  double depth_ = 1;  ///< of the target along the view direction [m]
  double view_cosine_ = 1;
  Vec3 target_ = Vec3::Zero();
};

}  // namespace tumble
