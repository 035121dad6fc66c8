#pragma once
#include "engine/collision/gjk/simplex.hpp"

namespace tumble {

enum class GjkStatus {
  separated,       ///< the distance is positive and known
  intersecting,    ///< the cores overlap or touch
  beyond,          ///< the distance is more than asked for; `distance` is a lower bound
  max_iterations,  ///< `distance` and `lower_bound` enclose the answer
};

struct GjkResult {
  GjkStatus status = GjkStatus::separated;
  double distance = 0;         ///< between the witness points [m]
  double lower_bound = 0;      ///< the true distance is between this and `distance` [m]
  Vec3 a = Vec3::Zero();       ///< witness on A's core, query frame
  Vec3 b = Vec3::Zero();       ///< witness on B's core
  Vec3 normal = Vec3::Zero();  ///< unit, from A to B; zero when intersecting
  int iterations = 0;
  Simplex simplex;  ///< where it ended; EPA goes on from here

  bool converged() const { return status != GjkStatus::max_iterations; }
};

struct GjkOptions {
  double max_distance = std::numeric_limits<double>::infinity();  ///< stop when beyond [m]
  double relative_tolerance = 1e-12;  ///< of the distance: stop when the bounds are this close
  int max_iterations = 128;
  Vec3 initial_direction = Vec3::Zero();  ///< from A to B, of an earlier query; zero if none
};

/// Closest points of two convex cores (Gilbert, Johnson & Keerthi 1988; Coutinho §4.10), without
/// their rounding. Ends when the gap between the distance found and the lower bound given by the
/// last support plane is below the tolerance, or when rounding lets nothing improve any more.
/// Distances below 1e-14 of the coordinates' size count as intersecting.
GjkResult gjk(const PlacedCore& A, const PlacedCore& B, const GjkOptions& options = {});

}  // namespace tumble
