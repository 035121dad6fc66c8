#pragma once
#include "engine/dynamics/grains/grain_rows.hpp"

#include <span>

namespace tumble {

/// The grains and bodies of rows between them.
struct GrainWalls {
  std::span<GrainPoint> points;
  std::span<GrainMover> movers;
  std::span<GrainBody> bodies;
};

/// Rows of grains with bodies, one after the other, in the steps of a sub-step (solve_grains.hpp).
/// Applies the impulses of the previous sub-step, rotated into the present tangent plane.
void warm_start(const GrainWalls& in, std::span<GrainBodyRow> rows);
void sweep(const GrainWalls& in, std::span<GrainBodyRow> rows, double inverse_hs);
/// Moves grains out of overlap, `time` seconds after the beginning of the part.
void part_overlapping(const GrainWalls& in, std::span<GrainBodyRow> rows, double time);
/// Updates gaps to the present positions.
void follow(const GrainWalls& in, std::span<GrainBodyRow> rows, double time);
/// Adds the impulses of a sub-step to those of the part.
void count_impulses(std::span<GrainBodyRow> rows);
/// Applies restitution, and adds its impulses to those of the part.
void bounce(const GrainWalls& in, std::span<GrainBodyRow> rows, double threshold);

}  // namespace tumble
