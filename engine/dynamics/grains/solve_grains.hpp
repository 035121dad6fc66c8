#pragma once
#include "engine/core/crew.hpp"
#include "engine/dynamics/grains/grain_rows.hpp"

#include <span>
#include <vector>

namespace tumble {

/// All that a part of a tick solves. Pairs of one colour share no grain that moves, and are
/// solved by any thread in any order; so are walls of different grains. Rows with bodies that
/// give way are solved one after the other.
struct GrainSystemRows {
  std::span<Vec3> x;
  std::span<GrainMover> movers;
  std::span<const Vec3> acceleration;  ///< 0 while they sleep [m/s2]
  std::span<const uint8_t> touched;    ///< has a row
  std::span<const double> radius;
  std::span<GrainBody> bodies;
  std::span<GrainRow> pairs;               ///< by colour
  std::span<const uint32_t> colour_first;  ///< index of each colour's first pair, then the end
  std::span<GrainBodyRow> walls;           ///< with what does not give way; by grain
  std::span<GrainBodyRow> held;            ///< with bodies that do
  double restitution_threshold = 0;        ///< [m/s]
};

/// `substeps` sub-steps of hs seconds each: warm start, a sweep over velocities, motion, a sweep
/// over positions that works off overlap, one more over velocities; at the end restitution, once.
/// Projected Gauss-Seidel by colours.
void solve_grains(const GrainSystemRows& rows, int substeps, double hs, Crew* crew);

/// Pairs in an order by colours, of which no two neighbours have the same; `first` as in
/// GrainSystemRows. What has no colour left gets one of its own.
void colour_pairs(std::span<const GrainRow> pairs, std::span<const GrainMover> movers,
                  std::vector<uint32_t>& order, std::vector<uint32_t>& first,
                  std::vector<uint32_t>& scratch, std::vector<uint64_t>& used);

}  // namespace tumble
