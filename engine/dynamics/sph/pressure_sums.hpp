#pragma once
#include "engine/dynamics/sph/fluid_sums.hpp"

#include <cstdint>

namespace tumble {

// Sums over pairs for the iterations of the pressure solve, which need no more digits than single
// precision and slopes of 16 bits. They are of one list of gradients: slopes, times what corrects
// them, times the ways from the other particles. Rates gather what the others' velocities say;
// pressures push by the transpose, and a particle gathers what the others push it by, of their
// corrections and its own slopes, which are those of both. So nobody writes to what is another's.
// The order of every sum is the same for all instruction sets and numbers of threads.

/// A position, in parts of the kernel's reach and modulo a few reaches: differences of particles
/// that are in reach of each other are right however far they are from the origin.
struct FluidPlace {
  static constexpr int bits = 14;  ///< of a reach
  int32_t xy = 0;                  ///< 16 bits each, x the lower ones
  int32_t z = 0;                   ///< in the upper 16 bits
  /// Of a position over the reach [-].
  static FluidPlace of(const Vec3& x);
};

/// What rates are of; by place.
struct alignas(32) FlowRow {
  FluidPlace at;
  int32_t unused[2] = {0, 0};
  SingleVector flow;  ///< velocity or acceleration, times volume; w: 0
};
/// What plain pushes are of.
struct alignas(16) PushRow {
  FluidPlace at;
  float weight = 0;  ///< pressure times volume
  float unused = 0;
};
/// What corrected pushes are of: a symmetric matrix, the weight times the correction.
struct alignas(32) StressRow {
  FluidPlace at;
  float xx = 0, yy = 0;
  float zz = 0, yz = 0, zx = 0, xy = 0;
  void set(const SymmetricRow<float>& m) {
    xx = m.xx, yy = m.yy, zz = m.zz, yz = m.yz, zx = m.zx, xy = m.xy;
  }
};

// They are for the particles of the groups from `first` to `end`, by place from the first one's on.
// Lengths are in reaches of the kernel, slopes in slope units.

/// The sum of flows times gradients, of each; no corrections: null.
void open_groups(const FluidPairs& pairs, size_t first, size_t end, const FlowRow* rows,
                 const SymmetricRow<float>* corrections, float* sums);
/// The sum of f w d over the others, w their weights and d the ways from them; w: 0.
void push_groups(const FluidPairs& pairs, size_t first, size_t end, const PushRow* rows,
                 SingleVector* sums);
/// The sum of f T d, T the matrices of the others.
void push_groups(const FluidPairs& pairs, size_t first, size_t end, const StressRow* rows,
                 SingleVector* sums);

}  // namespace tumble
