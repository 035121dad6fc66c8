#pragma once
#include "engine/collision/continuous/moving_pair.hpp"
#include "engine/collision/continuous/probe.hpp"

namespace tumble {

/// First contact by bisection (Coutinho 2013 §1.4.4, 1.4.6): the time of contact is bracketed
/// between a moment known to be apart, with all before it, and later moments.
///
/// Between two moments at distances d and e the gap cannot close when d/s + e/r covers the time
/// between them, s bounding how fast the gap closes along the first normal and r how fast it opens
/// along the second: no contact, however short, is skipped. What is not covered is divided where
/// the nearest points would meet (Newton), in the middle, or at the end of the step that is safe
/// for certain. Status initially_overlapping when the two are within the tolerance at t0.
TimeOfContact bisect(MovingDistance& distance, double t0, double t1, double tolerance,
                     ContactTimeTrace* trace = nullptr);

/// The method "bisection": convex shapes and half-spaces by `bisect` on their distance; meshes by
/// the distance of the nearest triangles over their hierarchies, unless they are within the
/// tolerance at the start: then by conservative advancement of the other triangles, and the answer
/// says so.
TimeOfContact find_by_bisection(const MovingPair& pair);

}  // namespace tumble
