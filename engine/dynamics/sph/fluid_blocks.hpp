#pragma once
#include "engine/dynamics/sph/fluid_sums.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// Particles whose places follow each other, and which are therefore near each other; their
/// neighbours, each once; and their pairs, which name neighbours by their row among these. What a
/// sum needs of the neighbours is gathered once for all pairs of the block, into memory that stays
/// in a near cache, with positions relative to the block's centre, so that single precision
/// suffices.
struct FluidBlock {
  size_t first;                    ///< place of the first particle
  Vec3 centre;                     ///< [m]
  std::span<const uint32_t> rows;  ///< by row: place of the neighbour
  std::span<const uint32_t> ends;  ///< by particle: number of pairs up to its last
  const uint16_t* others;          ///< by pair: row
  const float* slopes;             ///< by pair, as in FluidList
};

/// Blocks of particles whose places follow each other.
class FluidBlocks {
 public:
  /// Makes blocks of the particles from place `first` on, whose lists are these ranges of `store`.
  /// `points` are by place; the last of them fills lists up. False where a block has more
  /// neighbours than can be numbered.
  [[nodiscard]] bool make(const FluidPairStore& store, size_t first,
                          std::span<const FluidPairStore::Range> ranges,
                          std::span<const FluidVector> points, double reach);
  void clear() { parts_.clear(); }
  size_t size() const { return parts_.size(); }
  FluidBlock operator[](size_t k) const;
  static constexpr size_t most_rows = size_t{UINT16_MAX} + 1;  ///< of a block

 private:
  struct Part {
    size_t first, end;
    Vec3 centre;
    size_t first_row, end_row, first_pair;
  };
  size_t first_ = 0;
  std::vector<Part> parts_;
  std::vector<uint32_t> rows_, ends_;
  std::vector<uint16_t> others_;
  std::vector<float> slopes_;
};

}  // namespace tumble
