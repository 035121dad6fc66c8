#pragma once
#include "engine/dynamics/grains/grain_field.hpp"
#include "engine/dynamics/particles/neighbours/neighbour_lists.hpp"

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
  Status update_lists(const GrainTick& tick, const GrainField& grains, double h);
  template <class F>
  void near(size_t i, double reach, const F& f);
  void rouse(const GrainTick& tick, GrainField& grains);
  void find_of(const GrainField& grains, double h, size_t i, std::vector<GrainPair>& out);

  NeighbourLists lists_;
  std::vector<Vec3> by_ordinal_;   ///< [m]
  std::vector<uint32_t> list_of_;  ///< by place: which list is its own
  /// By list: where it is; for a radius what it may close in the part, relative to the mean
  /// velocity of all. Then a point far away, which fills lists.
  std::vector<GrainPoint> spots_;
  std::vector<uint32_t> place_of_;             ///< by list: whose it is
  std::vector<std::vector<GrainPair>> found_;  ///< by chunk
};

}  // namespace tumble
