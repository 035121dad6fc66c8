#pragma once
#include "engine/dynamics/grains/grain_rows.hpp"

#include <span>

namespace tumble {

/// What grains and bodies are while rows between them are solved.
struct GrainWalls {
  std::span<GrainPoint> points;
  std::span<GrainMover> movers;
  std::span<GrainBody> bodies;
};

/// Rows of grains with bodies, one after the other: the steps of a sub-step (solve_grains.hpp). The
/// impulses of the sub-step before, turned into the present tangent plane.
void warm_start(const GrainWalls& in, std::span<GrainBodyRow> rows);
void sweep(const GrainWalls& in, std::span<GrainBodyRow> rows, double inverse_hs);
/// Moves grains out of what they overlap, `time` seconds after the beginning of the part.
void part_overlapping(const GrainWalls& in, std::span<GrainBodyRow> rows, double time);
/// Gaps at the present places.
void follow(const GrainWalls& in, std::span<GrainBodyRow> rows, double time);
/// Adds the impulses of a sub-step to what the part has given.
void count_impulses(std::span<GrainBodyRow> rows);
/// Restitution; what it adds is counted.
void bounce(const GrainWalls& in, std::span<GrainBodyRow> rows, double threshold);

}  // namespace tumble
