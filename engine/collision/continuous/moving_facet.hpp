#pragma once
#include "engine/collision/motion.hpp"
#include "engine/collision/time_of_contact.hpp"

#include <array>

namespace tumble {

/// A moving point, segment or triangle of a shape, with a radius of rounding: the feature of a
/// surface that can touch first.
struct MovingFacet {
  std::array<Vec3, 3> corner;  ///< relative to the carrier's centre, world axes at motion.t0 [m]
  int corners = 3;
  double rounding = 0;  ///< points within this distance belong to it [m]
  const Motion* motion = nullptr;

  /// `points` are in the motion's frame; the first `count` of them are used.
  MovingFacet(const Motion& m, const std::array<Vec3, 3>& points, int count, double radius = 0);
  /// Greatest speed of a corner by rotation [m/s], and its centripetal acceleration [m/s2].
  double turning() const;
  double acceleration() const;
};

/// First contact of facet A with triangle B over [t0, t1], a part of the motions' interval
/// (Coutinho 2013 §4.6, 2.5.15). The interval is split until corners deviate from straight lines by
/// no more than a small part of the gap, or of the tolerance; every step is decided by the
/// certified tests of points, edges and triangles whose corners move linearly
/// (geometry/continuous_tests/), with that deviation added to the separation. Status
/// initially_overlapping when the two are within the tolerance at t0; features are not set.
TimeOfContact facet_contact(const MovingFacet& a, const MovingFacet& b, double t0, double t1,
                            double tolerance);

/// Time until which the two are proven to be farther apart than half the tolerance, by a bound from
/// their nearest points at t; t if they are within the tolerance at t [s].
double facets_apart_until(const MovingFacet& a, const MovingFacet& b, double t, double tolerance);

}  // namespace tumble
