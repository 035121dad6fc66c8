#pragma once
#include "engine/dynamics/realtime/solver_rows.hpp"

namespace tumble {

/// What gravity, force and torque, or a course, change the velocity of a solver body by in `hs`.
BodyVelocity gained_velocity(const SolverContext& context, const SolverIsland& island,
                             uint32_t body, double hs);
/// Changes velocities by gravity, force and torque over `hs`.
void integrate_velocities(const SolverContext& context, const SolverIsland& island, double hs);
/// Moves positions and orientations over a sub-step; changes the angular velocity so that angular
/// momentum is conserved.
void integrate_positions(const SolverContext& context, const SolverIsland& island, double hs);
/// Moves a body that nothing touches over a whole tick: the exact parabola under uniform gravity,
/// other forces as one impulse at the start (symplectic Euler), rotation by the midpoint rule with
/// exact angular momentum.
void fly(RigidBody& body, const Vec3& gravity, double h);
/// Moves a kinematic body over a whole tick.
void carry(RigidBody& body, double h);
/// Copies the end state of an island's bodies back.
void store_bodies(const SolverContext& context, const SolverIsland& island);

/// One step of torque-free rotation: `q` and world `omega` after `h`, with the angular momentum at
/// its start. Midpoint rule on the rotation group, by `midpoint_iterations` fixed-point iterations.
void rotate_freely(const RigidBody& body, Quat& q, Vec3& omega, double h);

}  // namespace tumble
