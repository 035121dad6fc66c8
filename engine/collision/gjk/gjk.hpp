#pragma once
#include "engine/collision/gjk/simplex.hpp"

namespace tumble {

enum class GjkStatus {
  separated,       ///< the distance is positive and known
  intersecting,    ///< the cores overlap or touch
  beyond,          ///< the distance is more than `max_distance`; `distance` is a lower bound
  max_iterations,  ///< `distance` and `lower_bound` enclose the answer
};

struct GjkResult {
  GjkStatus status = GjkStatus::separated;
  double distance = 0;  ///< between the witness points [m]
  /// Certain: there is a plane with all of A on one side and all of B this far beyond it, rounding
  /// included [m].
  double lower_bound = 0;
  Vec3 a = Vec3::Zero();       ///< witness on A's core, query frame
  Vec3 b = Vec3::Zero();       ///< witness on B's core
  Vec3 normal = Vec3::Zero();  ///< unit, from A to B; zero when intersecting
  int iterations = 0;
  bool precise = false;  ///< the last simplices were in double-double arithmetic
  Simplex simplex;       ///< the last one, in A's frame; EPA and the next query start from it

  bool converged() const { return status != GjkStatus::max_iterations; }
};

struct GjkOptions {
  double max_distance = std::numeric_limits<double>::infinity();  ///< stop when beyond [m]
  /// Relative to the distance: stop when the bounds are this close. Bounds within 1e-13 of the
  /// scale also stop the search.
  double relative_tolerance = 1e-12;
  int max_iterations = 128;
  Vec3 initial_direction = Vec3::Zero();  ///< from A to B, of an earlier query; zero if none
  /// The last simplex of an earlier query of the same two cores, whose vertices start this one.
  /// Takes precedence over the direction; cannot be used by curved cores.
  const Simplex* start = nullptr;
};

/// Closest points of two convex cores without their radii of rounding (Gilbert, Johnson & Keerthi,
/// "A fast procedure for computing the distance between complex objects in three-dimensional
/// space", 1988; van den Bergen, "A fast and robust GJK implementation for collision detection of
/// convex objects", 1999; Coutinho §4.10).
///
/// v, the point of the simplex nearest to the origin, bounds the distance from above; the support
/// plane with normal v bounds it from below. The search ends when
///   - the bounds are within the tolerance (separated),
///   - the support plane is further than `max_distance` (beyond),
/// - the simplex contains the origin, or |v| is below 1e-14 of the scale (intersecting).
/// Steps are in double precision as long as they get nearer. If one does not (slivers, gaps of a
/// few rounding errors), the search continues from the last simplex in double-double arithmetic, so
/// that the remaining difference of the bounds for two polyhedra is the rounding of the support
/// function: below 1e-12 of the scale (both reaches and the distance of the origins).
GjkResult gjk(const PlacedCore& A, const PlacedCore& B, const GjkOptions& options = {});

}  // namespace tumble
