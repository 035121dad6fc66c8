#pragma once
#include "engine/collision/continuous/convex_distance.hpp"
#include "engine/collision/continuous/probe.hpp"
#include "engine/collision/time_of_contact.hpp"

namespace tumble {

/// Conservative advancement (Mirtich, "Impulse-based dynamic simulation of rigid body systems",
/// 1996; Coutinho 2013 §13) over [t0, t1], a part of the motions' interval: steps no longer than
/// the distance over a bound on the approach along the closest direction. Status
/// initially_overlapping when the two are within the tolerance at t0.
TimeOfContact advance(MovingDistance& pair, double t0, double t1, double tolerance,
                      ContactTimeTrace* trace = nullptr);

/// The same for two convex cores, with their radii of rounding.
TimeOfContact advance(const MovingCore& a, const MovingCore& b, double t0, double t1,
                      double tolerance, ContactTimeTrace* trace = nullptr);

/// The same for the half-space y <= 0 of a moving frame (A) and a convex core.
TimeOfContact advance_half_space(const Motion& plane, const MovingCore& b, double t0, double t1,
                                 double tolerance, ContactTimeTrace* trace = nullptr);

}  // namespace tumble
