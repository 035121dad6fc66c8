#pragma once
#include "engine/collision/motion.hpp"
#include "engine/dynamics/bodies/body.hpp"

namespace tumble {

/// Whether a body turns so far in a tick of `h` seconds that the shortest rotation between its
/// poses may not be the actual one.
bool winds(const RigidBody& body, double h);

/// The motion in a tick of `h` seconds from pose `start` to `body.pose`.
Motion tick_motion(const Pose& start, const RigidBody& body, double h);

/// Bound on how far a point within `radius` [m] of the centre goes when a body turns from one
/// orientation to another: the angle is 2 asin of the sine of its half, at most pi times it, and no
/// point comes farther than twice its distance [m].
double turned_by(const Quat& from, const Quat& to, double radius);

/// Upper bound on the displacement of any point of a body in a tick that began at `start` [m].
double way_of(const RigidBody& body, const Pose& start, double h);

/// How far a body may move in a tick without being tested [m]: its foresight(); for a thin convex
/// body, which has no inside from which it could be pushed out, at most a fiftieth of its size.
double unwatched(const RigidBody& body);

/// The same for one shape of a body, which may be small compared with the body [m].
double unwatched(const RigidBody& body, const Shape& shape);

/// Sets a body to another pose on its path in the tick. The angular velocity is rotated with it,
/// which keeps its energy: combined with the inertia tensor of another orientation, a needle could
/// have many times as much.
void put_at(RigidBody& body, const Pose& pose);

}  // namespace tumble
