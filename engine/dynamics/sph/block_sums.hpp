#pragma once
#include "engine/dynamics/sph/fluid_blocks.hpp"

#include <vector>

namespace tumble {

/// A vector in single precision and one number more.
struct alignas(16) SingleVector {
  float x = 0, y = 0, z = 0, w = 0;
};

/// A particle as other blocks read it: one line of a cache for what is corrected, and half of one
/// for what flows.
struct alignas(64) BlockMatrix {
  SingleVector at;             ///< as in BlockFlow
  SingleVector correction[3];  ///< columns [-]
};
struct alignas(32) BlockFlow {
  SingleVector at;  ///< from the centre of its block [length units]; w: number of the block
  SingleVector u;   ///< acceleration [m/s2] times volume [volume units]
};

/// What sums over blocks are of, by place. Lengths are in reaches of the kernel, and volumes in
/// parts of its scale, so that no unit takes single precision out of its range.
struct BlockOperands {
  double length_unit = 1;                 ///< [m]
  const FluidVector* centres = nullptr;   ///< by block [m]
  const BlockMatrix* matrices = nullptr;  ///< null: slopes are plain
  BlockFlow* flows = nullptr;
  const float* weights = nullptr;  ///< pressure [Pa] times volume [volume units]
  /// Sum of V f d, corrected, with those of walls [1/length unit], over the volume; w: volume over
  /// density and length unit [m2/kg].
  const SingleVector* gradients = nullptr;
};

/// Memory for the numbers of a block's neighbours.
using BlockScratch = std::vector<SingleVector>;

// The two operators of pressure_solve in single precision, by the expansions of fluid_state about
// the centre of a block. Sums are in an order that is the same for every instruction set.

/// Makes the flows of the particles of a block by the pressures of their neighbours.
void press_block(const BlockOperands& of, const FluidBlock& block, BlockScratch& scratch);
/// Rates at which flows change the rates of their shares, walls at rest, by particle of the block
/// [m/s2 per length unit].
void open_block(const BlockOperands& of, const FluidBlock& block, float* rates,
                BlockScratch& scratch);

}  // namespace tumble
