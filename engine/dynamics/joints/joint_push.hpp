#pragma once
#include "engine/math/types.hpp"

namespace tumble {

/// Force and torque of a joint on B, world axes; the torque is about B's anchor. The opposite acts
/// on A at the same point.
struct JointWrench {
  Vec3 force = Vec3::Zero();   ///< [N]
  Vec3 torque = Vec3::Zero();  ///< [N m]
};

/// Impulses of a joint on its bodies over a tick, or a part of it, world axes.
struct JointPush {
  Vec3 impulse = Vec3::Zero();   ///< on B; the negative on A [N s]
  Vec3 moment_a = Vec3::Zero();  ///< angular impulse on A, about its centre of mass [N m s]
  Vec3 moment_b = Vec3::Zero();  ///< on B, likewise
  /// On B about its anchor, wherever that is at each moment of the tick [N m s].
  Vec3 twist = Vec3::Zero();
  /// Work of motors, dry friction and limits along the coordinates, included in the work of the
  /// above [J].
  double motors = 0, friction = 0, limits = 0;

  void add(const JointPush& p) {
    impulse += p.impulse;
    moment_a += p.moment_a;
    moment_b += p.moment_b;
    twist += p.twist;
    motors += p.motors;
    friction += p.friction;
    limits += p.limits;
  }
};

}  // namespace tumble
