#pragma once
#include "engine/collision/motion.hpp"
#include "engine/collision/time_of_contact.hpp"

#include <array>

namespace tumble {

/// A point, segment or triangle of a shape on its way, with a rounding: what touches first.
struct MovingFacet {
  std::array<Vec3, 3> corner;  ///< about the carrier's centre, in world axes at motion.t0 [m]
  int corners = 3;
  double rounding = 0;  ///< all points within this belong to it [m]
  const Motion* motion = nullptr;

  /// `points` in the motion's frame; one, two or three of them count.
  MovingFacet(const Motion& m, const std::array<Vec3, 3>& points, int count, double radius = 0);
  /// Greatest speed of turning of a corner [m/s], and the centripetal acceleration there [m/s2].
  double turning() const;
  double acceleration() const;
};

/// First contact of facet A with triangle B over [t0, t1], a part of the motions' interval
/// (Coutinho 2013 §4.6, 2.5.15). The interval is split where corners would depart from straight
/// lines by more than a small part of the gap, at last of the tolerance; every step is decided by
/// the certified tests of points, edges and triangles whose corners move linearly
/// (geometry/continuous_tests/), the departure added to the separation asked for. Status
/// initially_overlapping when the two are within the tolerance at t0; features are left unset.
TimeOfContact facet_contact(const MovingFacet& a, const MovingFacet& b, double t0, double t1,
                            double tolerance);

/// Until when the two are farther apart than half the tolerance for certain, by what is nearest at
/// t; t when they are within the tolerance there [s].
double facets_apart_until(const MovingFacet& a, const MovingFacet& b, double t, double tolerance);

}  // namespace tumble
