#pragma once
#include "engine/dynamics/sph/fluid_sums.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// Particles whose places follow each other, and which are therefore near each other; their
/// neighbours, each once; and their pairs, which name neighbours by their row among these. What the
/// neighbours give to the pairs of a block and get from them is memory of its own, which stays in a
/// near cache.
struct FluidBlock {
  size_t first;                    ///< place of the first particle
  std::span<const uint32_t> rows;  ///< by row: place of the neighbour
  std::span<const uint32_t> ends;  ///< by particle: number of pairs up to its last
  const uint16_t* others;          ///< by pair: row
  const float* slopes;             ///< by pair, as in FluidList
  size_t first_row, first_pair;    ///< among those of all blocks of FluidBlocks
};

/// Blocks of particles whose places follow each other.
class FluidBlocks {
 public:
  /// Makes blocks of the particles from place `first` on, whose lists are these ranges of `store`;
  /// places are below `places`, of which the last fills lists up. False where a block has more
  /// neighbours than can be numbered. The store is to last as long as the blocks.
  [[nodiscard]] bool make(const FluidPairStore& store, size_t first,
                          std::span<const FluidPairStore::Range> ranges, size_t places);
  void clear() { parts_.clear(), rows_.clear(); }
  size_t size() const { return parts_.size(); }
  size_t rows() const { return rows_.size(); }  ///< of all blocks
  FluidBlock operator[](size_t k) const;
  static constexpr size_t most_rows = size_t{UINT16_MAX} + 1;  ///< of a block

 private:
  struct Part {
    size_t first, end;
    size_t first_row, end_row, first_pair;
  };
  size_t first_ = 0;
  std::vector<Part> parts_;
  std::vector<uint32_t> rows_, ends_;
  std::vector<uint16_t> others_;   ///< by pair of the store
  const float* slopes_ = nullptr;  ///< likewise
};

}  // namespace tumble
