#pragma once
#include "engine/core/result.hpp"
#include "engine/dynamics/forces/pair/pair_law.hpp"
#include "engine/dynamics/particles/neighbours/neighbour_lists.hpp"

#include <span>
#include <vector>

namespace tumble {

/// Forces between all pairs of many points, by a law of their distance: over lists of neighbours
/// where the law ends somewhere, else over all. Each point sums over its own pairs, so that the
/// bits are the same for any number of threads. Keeps its memory.
class PairSums {
 public:
  struct Points {
    std::span<const Vec3> x;          ///< [m]
    std::span<const double> weights;  ///< charges, masses or ones
    PeriodicBox box;                  ///< only for laws that end
  };

  /// Refuses what NeighbourLists refuses, and a periodic box under a law without an end.
  Status sum(const PairLaw& law, const Points& points, Crew* crew);

  /// By the caller's index, of the last sum() [N].
  std::span<const Vec3> forces() const { return forces_; }
  double energy() const { return energy_; }  ///< [J]
  /// Sum of r.F over the pairs: N particles of temperature T have the pressure
  /// (N k T + virial / 3) / volume [J].
  double virial() const { return virial_; }

 private:
  void place_weights(std::span<const double> weights);

  NeighbourLists lists_;
  std::vector<double> x_, y_, z_, weight_;
  std::vector<Vec3> forces_;
  std::vector<double> energies_, virials_;  ///< by the caller's index
  double energy_ = 0, virial_ = 0;
};

}  // namespace tumble
