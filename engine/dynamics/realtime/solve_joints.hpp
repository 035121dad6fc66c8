#pragma once
#include "engine/dynamics/realtime/joint_pass.hpp"
#include "engine/dynamics/realtime/solver_rows.hpp"

namespace tumble {

/// Sub-steps of joints in the realtime solver. A sub-step is that of RATTLE (Andersen 1983):
/// impulses along the Jacobian of its start so that its end is on the joint, then impulses along
/// the Jacobian of its end so that velocities are too; both are warm-started on their own. Rows of
/// one joint are solved together, joints one after the other in the order of their ids.

/// Fills the blocks, which come with a, b and source set; bodies are prepared.
void prepare_joints(const SolverContext& context, const SolverIsland& island, double hs);
/// Rows and effective masses at the present poses and velocities.
void refresh_joints(const SolverContext& context, const SolverIsland& island, double hs);

/// Starts from the impulses of the sub-step before, but for bodies that turn too far
/// (tolerances.hpp).
void warm_start_joints(const SolverIsland& island, double hs, JointPass pass);
/// SolverIsland::joint_sweeps sweeps, there and back. `stiffness` is that of the moving pass,
/// as factors of the soft step.
void solve_joints(const SolverIsland& island, double hs, const Softness& stiffness, JointPass pass);
/// Adds the impulses of a pass to JointBlock::sum, by the rows that they went along.
void sum_joints(const SolverIsland& island, JointPass pass);
/// How stiff joints are for sub-steps of `hs`.
Softness joint_softness(double hs);
/// Writes the impulses back to the joints, and their sums; gives the greatest velocity left in a
/// row [m/s, rad/s].
double store_joints(const SolverContext& context, const SolverIsland& island, double hs);

}  // namespace tumble
