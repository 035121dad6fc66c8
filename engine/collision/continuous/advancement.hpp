#pragma once
#include "engine/collision/continuous/probe.hpp"
#include "engine/collision/gjk/gjk.hpp"
#include "engine/collision/time_of_contact.hpp"

namespace tumble {

/// A convex core on its way.
struct MovingCore {
  const ConvexCore& core;
  const Motion& motion;
  double lever;  ///< of the core with its rounding about the carrier's centre [m]
};

/// Conservative advancement of two convex cores (rounding included) over [t0, t1], a part of the
/// motions' interval. Status initially_overlapping when they are within the tolerance at t0.
TimeOfContact advance(const MovingCore& a, const MovingCore& b, double t0, double t1,
                      double tolerance, ContactTimeTrace* trace = nullptr);

/// The same for the half-space y <= 0 of a moving frame (A) and a convex core.
TimeOfContact advance_half_space(const Motion& plane, const MovingCore& b, double t0, double t1,
                                 double tolerance, ContactTimeTrace* trace = nullptr);

}  // namespace tumble
