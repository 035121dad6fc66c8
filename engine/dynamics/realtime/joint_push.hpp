#pragma once
#include "engine/math/types.hpp"

namespace tumble {

/// What a joint did to its bodies over a tick, or a part of it, world axes.
struct JointPush {
  Vec3 impulse = Vec3::Zero();   ///< on B; minus it on A [N s]
  Vec3 moment_a = Vec3::Zero();  ///< on A, about its centre [N m s]
  Vec3 moment_b = Vec3::Zero();  ///< on B, likewise
};

}  // namespace tumble
