#pragma once
#include "engine/dynamics/sph/fluid_blocks.hpp"

#include <cstdint>
#include <vector>

namespace tumble {

/// A vector in single precision and one number more.
struct alignas(16) SingleVector {
  float x = 0, y = 0, z = 0, w = 0;
};

/// A neighbour as the pairs of one block see it, by row. Lengths are in reaches of the kernel, and
/// volumes in parts of its scale, so that no unit takes single precision out of its range.
struct alignas(32) BlockRow {
  SingleVector flow;  ///< velocity or acceleration, times volume [volume units]; w: 0
  /// Sum over the block's pairs with it of pressure, volume of the other and gradient; w: 0.
  SingleVector push;
};

/// A pair as the particle sees it whose list it is in. Sums over pairs wait for memory, and the
/// iterations for pressures need no more digits than these.
struct alignas(8) BlockPair {
  int16_t x, y, z;  ///< gradient [pair units of the particle]
  uint16_t row;     ///< of the other
};
/// As many as are summed at once.
struct alignas(32) BlockPairs {
  BlockPair all[FluidPairStore::batch];
};

/// In which rows of all blocks a particle is, by place: rows[k] for k from firsts[p] to
/// firsts[p + 1].
struct BlockCopies {
  const uint32_t* firsts;
  const uint32_t* rows;
};

/// What gradients are made of: kernel slopes, times what corrects them, times the way from the
/// other. By place; no corrections: null.
struct BlockPoints {
  const FluidVector* points;  ///< [m]
  const Mat3* corrections;    ///< [-]
  double length_unit;         ///< [m]
  double steepest;            ///< no slope times distance is larger [length units]
};

// Sums over the pairs of blocks. All are sums of one list of gradients, which are the kernel's
// slopes, times what corrects them, times the ways from the other particles: rates gather what the
// others' velocities say, and by the transpose a particle's pressure pushes the others. What
// particles are for each other lies in rows of their own for each block, so that blocks do not
// write to each other's memory. The order of every sum is the same for all instruction sets and
// numbers of threads.

/// Makes the pairs of a block; `volumes` are by place. `units` are by particle: the pair unit
/// [1/length unit]; `sums` too: the sum of the others' volumes times gradients, w: 0.
void make_pairs(const BlockPoints& of, const FluidBlock& block, const float* volumes,
                BlockPair* pairs, float* units, SingleVector* sums);

/// Particles `first` to `end` of a block: the sum of flows times gradients [pair units],
/// of each.
void open_pairs(const FluidBlock& block, const BlockPair* pairs, const BlockRow* rows, size_t first,
                size_t end, float* sums);
/// The same particles, with these pressures times volumes times pair units, push their neighbours.
void press_pairs(const FluidBlock& block, const BlockPair* pairs, const float* weights,
                 size_t first, size_t end, BlockRow* rows);

/// Flows of particles by their pressures: `weights` are pressures times volumes, `gradients` the
/// sums of a particle's own gradients and those of walls, over its volume, and as w its volume over
/// density and length unit [m2/kg]. Rows get the flows, and pushes of zero.
void flow_by_pushes(const BlockCopies& copies, size_t first_place, size_t last_place,
                    const SingleVector* gradients, const float* weights, SingleVector* flows,
                    BlockRow* rows);
/// Rows get flows that are given, and pushes of zero.
void spread_flows(const BlockCopies& copies, size_t first_place, size_t last_place,
                  const SingleVector* flows, BlockRow* rows);

/// In double, for all particles of a block: they push their neighbours, and themselves by the
/// opposite, so that the sum of volumes times pushes is zero but for rounding. `weights` are
/// pressures times volumes by place; w of a row is the volume of the particle. `own` is by
/// particle: the sum of the volumes of others times what it pushes them by.
void press_exactly(const BlockPoints& of, const FluidBlock& block, const double* weights,
                   FluidVector* rows, FluidVector* own);

}  // namespace tumble
