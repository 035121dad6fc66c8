#pragma once
#include <cstdint>

namespace tumble {

/// Passes over the joints in a sub-step: impulses such that its motion satisfies the joints
/// (moving); further ones that also reduce position errors (correcting); and, at the poses of its
/// end, those that make velocities satisfy the joints (relaxing).
enum class JointPass : uint8_t { moving, correcting, relaxing };

/// A range of the sweeps of a sub-step over its joints; even ones go forwards, odd ones backwards.
struct JointSweeps {
  int begin = 0, end = 0;
};

/// The sweeps of a pass over an ordinary island: `n` in the moving and relaxing passes, one more in
/// the correcting pass.
inline JointSweeps sweeps_of(JointPass pass, int n) {
  if (pass == JointPass::correcting) return {n, n + 1};
  return {0, n};
}

}  // namespace tumble
