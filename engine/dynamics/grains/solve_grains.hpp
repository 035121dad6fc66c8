#pragma once
#include "engine/core/crew.hpp"
#include "engine/dynamics/grains/pair_kernels.hpp"
#include "engine/dynamics/grains/solve_walls.hpp"

#include <span>
#include <vector>

namespace tumble {

/// The grains that have contacts, while these are solved. Scratch memory.
struct GrainMotion {
  std::vector<GrainRow> rows;
  std::vector<GrainShift> shifts;
  std::vector<GrainShift> kicks;  ///< change of velocity by forces in a sub-step [m/s]
};

/// Everything that is solved in a part of a tick.
struct GrainSystemRows {
  std::span<GrainPoint> points;
  std::span<GrainMover> movers;
  std::span<const Vec3> acceleration;  ///< 0 while asleep [m/s2]
  std::span<const uint8_t> touched;    ///< by grain: has a contact
  double mass_unit;                    ///< of `motion` and of impulses of pairs [kg]
  GrainMotion& motion;
  GrainBundles& pairs;
  std::span<GrainBody> bodies;
  std::span<GrainBodyRow> walls;     ///< with immovable bodies; sorted by grain
  std::span<GrainBodyRow> held;      ///< with movable bodies
  double restitution_threshold = 0;  ///< [m/s]
};

/// Energy lost at contacts of two grains in a part [J].
struct GrainPairWork {
  double lost = 0, rubbed = 0;  ///< by normal impulses; by friction and torques
};

/// Takes `substeps` sub-steps of hs seconds each: warm start, a sweep over velocities, motion, one
/// more sweep over velocities that also reduces overlap; after the last, restitution. Projected
/// Gauss-Seidel: blocks in parallel, then contacts between blocks colour by colour, then rows with
/// bodies, those with movable bodies one after the other. Grains without contacts move along exact
/// parabolas.
GrainPairWork solve_grains(const GrainSystemRows& rows, int substeps, double hs, Crew* crew);

}  // namespace tumble
