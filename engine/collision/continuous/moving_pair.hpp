#pragma once
#include "engine/collision/continuous/convex_distance.hpp"
#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/collision/time_of_contact.hpp"

namespace tumble {

/// The input of a method. A comes before B in the order half-space, convex, mesh.
struct MovingPair {
  const Shape& a;
  const Motion& motion_a;
  const Shape& b;
  const Motion& motion_b;
  double tolerance;  ///< [m]
  const TimeOfContactOptions& options;

  double t0() const { return motion_a.t0; }
  double t1() const { return motion_a.t1; }
  /// Largest distance of a point of the shape from the carrier's centre [m].
  double lever_a() const { return motion_a.lever(a.bounding_radius()); }
  double lever_b() const { return motion_b.lever(b.bounding_radius()); }
  /// Bound on the speed of any point of A relative to any of B's [m/s].
  double speed() const;
  /// Bound on the displacement of any point of A relative to any of B between the middle of a part
  /// of the interval and its ends [m]; for a shape far from its carrier's centre far less than from
  /// speed().
  double drift(double from, double to) const;
  bool half_space() const { return a.is_half_space(); }
  bool both_convex() const { return a.convex() && b.convex(); }
  const MeshSurface& surface_a() const { return a.polyhedral()->surface(); }
  const MeshSurface& surface_b() const { return b.polyhedral()->surface(); }
  /// For convex shapes; with Voronoi planes if the options choose V-Clip.
  MovingCore core_a() const;
  MovingCore core_b() const;
};

}  // namespace tumble
