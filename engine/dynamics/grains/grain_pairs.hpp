#pragma once
#include "engine/dynamics/grains/grain_field.hpp"
#include "engine/dynamics/particles/neighbours/neighbour_lists.hpp"

#include <utility>
#include <vector>

namespace tumble {

/// Which grains touch each other, or may within a part of a tick.
class GrainPairs {
 public:
  /// Fills `out` with pairs (lower, higher index) in their order of which one at least is awake.
  /// Before that grains wake that something touches which moves. `speed` bounds how fast any two
  /// approach each other [m/s]; the part takes `h` seconds.
  Status find(const GrainTick& tick, GrainField& grains, double h, double speed,
              std::vector<std::pair<uint32_t, uint32_t>>& out);

 private:
  template <class F>
  void near(size_t i, const F& f) const;
  void rouse(const GrainTick& tick, GrainField& grains);

  NeighbourLists lists_;
  std::vector<uint32_t> places_;  ///< by grain
};

}  // namespace tumble
