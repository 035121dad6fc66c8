#pragma once
#include "engine/collision/continuous/moving_pair.hpp"
#include "engine/collision/continuous/probe.hpp"

namespace tumble {

/// First contact by bisection (Coutinho 2013 §1.4.4, 1.4.6): it is bracketed between a time until
/// which the shapes are known to be apart, and later times.
///
/// Between two times at which the distances are d and e, the gap cannot close if d/s + e/r exceeds
/// the time between them, where s bounds the rate at which the gap closes along the first normal,
/// and r the rate at which it opens along the second: no contact is skipped, however short. An
/// interval that fails the test is divided at the time at which the nearest points would meet
/// (Newton), in the middle, or at the end of the step that is proven safe. Status
/// initially_overlapping when the distance is within the tolerance at t0.
TimeOfContact bisect(MovingDistance& distance, double t0, double t1, double tolerance,
                     ContactTimeTrace* trace = nullptr);

/// The method "bisection": convex shapes and half-spaces by `bisect` on their distance; meshes by
/// the distance of the nearest triangles, found by their hierarchies. Meshes that are within the
/// tolerance at the start are left to conservative advancement of the other triangles, and the
/// result names that method.
TimeOfContact find_by_bisection(const MovingPair& pair);

}  // namespace tumble
