#pragma once
#include "engine/core/crew.hpp"
#include "engine/dynamics/grains/pair_kernels.hpp"
#include "engine/dynamics/grains/solve_walls.hpp"

#include <span>
#include <vector>

namespace tumble {

/// All that a part of a tick solves.
struct GrainSystemRows {
  std::span<GrainPoint> points;
  std::span<GrainMover> movers;
  std::span<const Vec3> acceleration;  ///< 0 while they sleep [m/s2]
  std::span<const uint8_t> touched;    ///< has a row
  GrainBundles& pairs;
  std::span<GrainBody> bodies;
  std::span<GrainBodyRow> walls;     ///< with what does not give way; by grain
  std::span<GrainBodyRow> held;      ///< with bodies that do
  double restitution_threshold = 0;  ///< [m/s]
};

/// What pairs of grains lost in a part [J].
struct GrainPairWork {
  double lost = 0, rubbed = 0;  ///< by normal impulses; by friction and torques
};

/// `substeps` sub-steps of hs seconds each: warm start, a sweep over velocities, motion, a sweep
/// over positions that works off overlap, one more over velocities; at the end restitution, once.
/// Projected Gauss-Seidel: blocks side by side, then what is between them by colours, then rows
/// with bodies. Those that give way are solved one after the other.
GrainPairWork solve_grains(const GrainSystemRows& rows, int substeps, double hs, Crew* crew);

}  // namespace tumble
