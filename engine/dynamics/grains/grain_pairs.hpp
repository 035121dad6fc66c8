#pragma once
#include "engine/dynamics/grains/grain_cells.hpp"
#include "engine/dynamics/grains/grain_field.hpp"

#include <vector>

namespace tumble {

/// Two grains that touch, or may do so within a part of a tick; `a` has the lower key.
struct GrainPair {
  uint32_t a, b;  ///< places
};

/// Pairs sorted by the place of `a`, then by the key of `b`.
struct GrainPairList {
  static constexpr uint32_t none = ~uint32_t{0};  ///< stands for an index of a pair or touch

  std::vector<GrainPair> all;
  std::vector<uint32_t> first;  ///< by place of a: index of its first pair; then the end
};

/// Finds grains that touch each other, or may do so within a part of a tick.
class GrainPairs {
 public:
  /// Lists pairs at least one of which is awake and whose gap their relative motion could close in
  /// the part of `h` seconds. First wakes sleeping grains that a moving one touches.
  Status find(const GrainTick& tick, GrainField& grains, double h, GrainPairList& out);

 private:
  /// Work of one thread.
  struct Search {
    GrainCells::Near near;
    std::vector<GrainPair> found;    ///< grain by grain, in the order of the cells
    std::vector<uint64_t> partners;  ///< of one grain: ordinal in the upper half, and place
    std::vector<uint32_t> roused;
    uint32_t first = 0, last = 0;  ///< range of grains in that order
  };
  Status sort(const GrainTick& tick, const GrainField& grains, double h);
  /// Calls f(search, cell) with the grains near it, for all cells with wants(index of the cell).
  template <class Wants, class F>
  void each_cell(Crew* crew, const Wants& wants, const F& f);
  void rouse(const GrainTick& tick, GrainField& grains);
  static bool may_meet(const GrainField& grains, uint32_t i, uint32_t j, double h);
  void find_of(const GrainField& grains, double h, uint32_t k, Search& search);

  GrainCells cells_;
  /// By place: how it may move in the part relative to the mean of all grains [m]
  std::vector<Vec3> ways_;
  std::vector<uint32_t> counts_;  ///< by place of a: number of pairs
  std::vector<Search> searches_;  ///< by chunk
};

}  // namespace tumble
