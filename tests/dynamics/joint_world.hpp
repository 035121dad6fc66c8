#pragma once
// Rigid bodies with joints under the realtime solver.
#include "engine/dynamics/bodies/pair_filter.hpp"
#include "tests/dynamics/joints_by_hand.hpp"
#include "tests/dynamics/rigid_world.hpp"

namespace tumble::test {

class JointWorld : public RigidWorld {
 public:
  explicit JointWorld(double hz = 60, int threads = 1) : RigidWorld(hz, threads) {
    settings.sleeping = false;
  }

  /// A joint at a frame in the world (z: main axis) between slots; no_body for the world.
  Joint& join(JointKind kind, uint32_t a, uint32_t b, const Pose& at, bool collide = false) {
    links.push_back({a, b, uint32_t(joints.size())});
    return joints.emplace_back(joint_at(kind, bodies, a, b, at, collide));
  }
  /// Greatest error of a joint's rows now [m, rad].
  double joint_error() const { return worst_error(joints, bodies); }
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
