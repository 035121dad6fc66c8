#pragma once
// Rigid bodies with joints under the realtime solver.
#include "engine/dynamics/joints/joint.hpp"
#include "engine/dynamics/rigid/pair_filter.hpp"
#include "tests/dynamics/rigid_world.hpp"

namespace tumble::test {

class JointWorld : public RigidWorld {
 public:
  explicit JointWorld(double hz = 60) : RigidWorld(hz) { settings.sleeping = false; }

  /// A joint at a frame in the world (z: main axis) between slots; no_body for the world.
  Joint& join(JointKind kind, uint32_t a, uint32_t b, const Pose& at, bool collide = false) {
    Joint j;
    j.kind = kind;
    j.a = a;
    j.b = b;
    j.frame_a = a == no_body ? at : bodies[a].pose.inverse() * at;
    j.frame_b = bodies[b].pose.inverse() * at;
    j.collide = collide;
    links.push_back({a, b, uint32_t(joints.size())});
    joints.push_back(j);
    return joints.back();
  }
  /// Greatest error of a joint's rows now [m, rad].
  double joint_error() const {
    double worst = 0;
    for (const Joint& j : joints) {
      JointRows rows;
      joint_rows(j.kind, joint_sides(j, bodies), rows);
      for (const JointRow& r : rows.all()) worst = std::max(worst, std::fabs(r.error));
    }
    return worst;
  }
  double energy() const {
    double e = kinetic_energy();
    for (const RigidBody& b : bodies)
      if (b.dynamic()) e -= b.mass * gravity.dot(b.pose.x);
    return e;
  }
};

/// The frame with its z axis along `z` and its x axis near `x`, at a point.
inline Pose frame_along(const Vec3& at, const Vec3& z, const Vec3& x) {
  Mat3 R;
  R.col(2) = z.normalized();
  R.col(1) = R.col(2).cross(x).normalized();
  R.col(0) = R.col(1).cross(R.col(2));
  return {at, Quat(R)};
}

}  // namespace tumble::test
