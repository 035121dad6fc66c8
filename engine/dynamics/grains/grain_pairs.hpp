#pragma once
#include "engine/dynamics/grains/grain_cells.hpp"
#include "engine/dynamics/grains/grain_field.hpp"

#include <vector>

namespace tumble {

/// Two grains that touch or may: `a` has the lower key.
struct GrainPair {
  uint32_t a, b;  ///< places
};

/// Pairs in the order of the places of `a`, those of one by ascending keys of `b`.
struct GrainPairList {
  static constexpr uint32_t none = ~uint32_t{0};  ///< in place of an index of a pair or a touch

  std::vector<GrainPair> all;
  std::vector<uint32_t> first;  ///< by place of a: index of its first pair; then the end
};

/// Which grains touch each other, or may within a part of a tick.
class GrainPairs {
 public:
  /// Lists pairs of which one at least is awake: those that are as near as their own approach can
  /// close in the part of `h` seconds. Before that grains wake that something touches which moves.
  Status find(const GrainTick& tick, GrainField& grains, double h, GrainPairList& out);

 private:
  /// What a thread works with.
  struct Search {
    GrainCells::Near near;
    std::vector<GrainPair> found;  ///< of one grain after the other, in the order of the cells
    std::vector<uint32_t> roused;
    uint32_t first = 0, last = 0;  ///< which grains, in that order
  };
  Status sort(const GrainTick& tick, const GrainField& grains, double h);
  /// f(search, cell), with what is near it, for all cells for whose index wants() says so.
  template <class Wants, class F>
  void each_cell(Crew* crew, const Wants& wants, const F& f);
  void rouse(const GrainTick& tick, GrainField& grains);
  void find_of(const GrainField& grains, double h, uint32_t k, Search& search);

  GrainCells cells_;
  std::vector<double> closes_;    ///< by place: what it may close in the part, relative to all [m]
  std::vector<uint32_t> counts_;  ///< of pairs, by place of a
  std::vector<Search> searches_;  ///< by chunk
};

}  // namespace tumble
