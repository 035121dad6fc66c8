#pragma once
#include "engine/dynamics/realtime/solver_rows.hpp"

namespace tumble {

/// Velocities after gravity, force and torque of a sub-step.
void integrate_velocities(const SolverContext& context, const SolverIsland& island, double hs);
/// Positions and orientations after a sub-step; turns the angular velocity so that angular
/// momentum stays.
void integrate_positions(const SolverContext& context, const SolverIsland& island, double hs);
/// A body that nothing touches, over a whole tick: the parabola of uniform gravity exactly, other
/// forces as one impulse at the start (symplectic Euler), rotation by the midpoint rule with exact
/// angular momentum.
void fly(RigidBody& body, const Vec3& gravity, double h);
/// A kinematic body over a whole tick.
void carry(RigidBody& body, double h);
/// Copies the end state of an island's bodies back.
void store_bodies(const SolverContext& context, const SolverIsland& island);

/// One step of torque-free rotation: `q` and world `omega` after `h`, for the angular momentum that
/// they had. Midpoint rule on the rotation group, by `midpoint_iterations` fixed-point iterations.
void rotate_freely(const RigidBody& body, Quat& q, Vec3& omega, double h);

}  // namespace tumble
