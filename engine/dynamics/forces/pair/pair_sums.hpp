#pragma once
#include "engine/core/result.hpp"
#include "engine/dynamics/forces/pair/pair_kernels.hpp"
#include "engine/dynamics/forces/pair/pair_law.hpp"
#include "engine/dynamics/particles/neighbours/neighbour_lists.hpp"

#include <array>
#include <span>
#include <vector>

namespace tumble {

/// Forces between all pairs of many points, by a law of their distance: over lists of neighbours
/// where the law ends somewhere, else over all. Each point sums over its own pairs, so that the
/// bits are the same for any number of threads. Keeps its memory, and lists for as long as they are
/// right; the bits are those of the points alone, whatever was asked before.
class PairSums {
 public:
  struct Points {
    std::span<const Vec3> x;          ///< [m]
    std::span<const double> weights;  ///< charges, masses or ones
    PeriodicBox box;                  ///< only for laws that end
  };

  // All refuse what NeighbourLists refuses, and a periodic box under a law without an end.
  Status push(const PairLaw& law, const Points& points, Crew* crew);     ///< forces() alone
  Status measure(const PairLaw& law, const Points& points, Crew* crew);  ///< energy() and virial()
  Status sum(const PairLaw& law, const Points& points, Crew* crew);      ///< all of it

  /// By the caller's index, of the last push() [N].
  std::span<const Vec3> forces() const { return forces_; }
  double energy() const { return energy_; }  ///< [J]
  /// Sum of r.F over the pairs: N particles of temperature T have the pressure
  /// (N k T + virial / 3) / volume [J].
  double virial() const { return virial_; }

  /// How often lists have been made.
  size_t lists_made() const { return made_; }

 private:
  Status prepare(const PairLaw& law, const Points& points, Crew* crew);
  Status update_lists(const PairLaw& law, const Points& points, Crew* crew);
  double next_skin(const Points& points, double reach) const;
  /// A point, and what a list names that is in reach of it, all in coordinates in which it is in
  /// the box.
  struct Near {
    PairPoint own;
    std::span<const PairPoint> in_reach;
  };
  Near near(const PairLaw& law, size_t place, std::span<const uint32_t> list,
            std::vector<PairPoint>& store) const;

  NeighbourLists lists_;
  double skin_ = 0;
  size_t updates_ = 0, made_ = 0;             ///< since lists were made; in all
  std::vector<PairPoint> points_;             ///< by place, or by index and filled up
  std::vector<std::vector<PairPoint>> near_;  ///< by chunk
  std::vector<Vec3> forces_;
  std::vector<PairEnergy> energies_;  ///< by the caller's index
  double energy_ = 0, virial_ = 0;
};

}  // namespace tumble
