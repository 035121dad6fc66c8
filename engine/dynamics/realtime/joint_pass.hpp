#pragma once
#include <cstdint>

namespace tumble {

/// Passes over the joints in a sub-step: impulses that keep its motion along the joints, those that
/// besides bring its end onto joints that are apart, and, with the bodies at its end, those that
/// keep velocities along the joints.
enum class JointPass : uint8_t { moving, correcting, relaxing };

/// Some of the sweeps of a sub-step over its joints, which go there and back: odd ones go back.
struct JointSweeps {
  int begin = 0, end = 0;
};

/// Those of a pass over an ordinary island: `n` before the bodies move and after it, and before it
/// one more, for errors.
inline JointSweeps sweeps_of(JointPass pass, int n) {
  if (pass == JointPass::correcting) return {n, n + 1};
  return {0, n};
}

}  // namespace tumble
