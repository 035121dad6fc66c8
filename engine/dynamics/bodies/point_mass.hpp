#pragma once
#include "engine/dynamics/bodies/body.hpp"

namespace tumble {

/// Whether a body has mass but no inertia, and so never rotates: that of a particle
/// (ParticleBlocks).
inline bool is_particle(const RigidBody& b) {
  return b.dynamic() && b.inverse_inertia_body(0, 0) == 0;
}

}  // namespace tumble
