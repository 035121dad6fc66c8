#pragma once
#include "engine/dynamics/grains/grain_rows.hpp"

#include <span>

namespace tumble {

/// The grains and bodies of rows between them.
struct GrainWalls {
  std::span<GrainShift> shifts;
  std::span<GrainRow> rows;
  std::span<const GrainMover> movers;  ///< their inverse masses
  std::span<GrainBody> bodies;
};

/// Rows of grains with bodies, one after the other, in the steps of a sub-step (solve_grains.hpp).
/// Applies the impulses of the previous sub-step, rotated into the present tangent plane.
void warm_start(const GrainWalls& in, std::span<GrainBodyRow> rows);
void sweep(const GrainWalls& in, std::span<GrainBodyRow> rows, double inverse_hs);
/// Moves grains out of overlap, `time` seconds after the beginning of the part.
void part_overlapping(const GrainWalls& in, std::span<GrainBodyRow> rows, double time);
/// The second sweep of a sub-step, at that time: updates gaps to the present positions, sweeps, and
/// adds the impulses of the sub-step to those of the part.
void follow(const GrainWalls& in, std::span<GrainBodyRow> rows, double time, double inverse_hs);
/// Applies restitution, and adds its impulses to those of the part.
void bounce(const GrainWalls& in, std::span<GrainBodyRow> rows, double threshold);

}  // namespace tumble
