#pragma once
#include "engine/collision/motion.hpp"
#include "engine/dynamics/bodies/body.hpp"

namespace tumble {

/// Whether a body turns so far in a tick of `h` seconds that the shortest way from pose to pose may
/// not be its way.
bool winds(const RigidBody& body, double h);

/// The motion over a tick of `h` seconds that began at `start` and ended at `body.pose`.
Motion tick_motion(const Pose& start, const RigidBody& body, double h);

/// Bound on how far any point of a body came in a tick that began at `start` [m].
double way_of(const RigidBody& body, const Pose& start, double h);

/// How far a body may come in a tick before it is watched [m]: as far as its contacts foresee, but
/// a thin convex one, which has no inside to be pushed out of, by no more than a fiftieth of its
/// size.
double unwatched(const RigidBody& body);

/// How far one shape of a body may come before it is watched [m]: the shape may be small beside the
/// body.
double unwatched(const RigidBody& body, const Shape& shape);

/// Sets a body to another pose on the way of its tick. Its angular velocity goes with it, so that
/// its energy stays: with the moments of inertia of another orientation a needle would have many
/// times as much.
void put_at(RigidBody& body, const Pose& pose);

}  // namespace tumble
