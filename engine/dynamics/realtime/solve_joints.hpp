#pragma once
#include "engine/dynamics/realtime/joint_pass.hpp"
#include "engine/dynamics/realtime/solver_rows.hpp"

#include <vector>

namespace tumble {

/// Sub-steps of joints in the realtime solver. A sub-step is that of RATTLE (Andersen 1983):
/// impulses along the Jacobian of its start so that its end is on the joint, then impulses along
/// the Jacobian of its end so that velocities are too; both are warm-started on their own. In
/// ordinary islands what works off errors that earlier sub-steps left is no part of that:
/// remembered, it would go on adding up while sweeps that have not converged leave the error, and
/// would set in motion slow modes of a mechanism, ever faster, from nothing. Rows of
/// one joint are solved together, joints one after the other in the order of their ids. What acts
/// along the coordinates of a joint (drive_row.hpp) has rows behind those of its parts: each is one
/// scalar problem with the compliance that the parts leave, so that a motor does not fight its own
/// hinge; where there are several they are solved one after the other until that is done.

/// Appends the rows of what acts along the coordinates of a joint; those of the island begin at
/// `first`.
void add_drives(const Joint& from, size_t first, JointBlock& joint, std::vector<DriveRow>& drives);

/// Fills the blocks, which come with a, b and source set; bodies are prepared.
void prepare_joints(const SolverContext& context, const SolverIsland& island, double hs);
/// Rows and effective masses at the present poses and velocities.
void refresh_joints(const SolverContext& context, const SolverIsland& island, double hs);

/// Starts a pass: the force laws of the coordinates, and the impulses of the sub-step before, but
/// for bodies that turn too far (tolerances.hpp).
void warm_start_joints(const SolverIsland& island, double hs, JointPass pass);
/// The sweeps of a precise island before the bodies move, and after it. Before it all of them work
/// off errors and are remembered: so many leave little of any mode.
void move_onto_joints(const SolverIsland& island, double hs);
void relax_joints(const SolverIsland& island, double hs);

// What these are made of, for islands of which only a part is in these rows.

/// Some sweeps of a pass.
void sweep_joints(const SolverIsland& island, double hs, JointPass pass, JointSweeps which);
/// Adds the impulses before the bodies moved (`moving`), or after that, to JointBlock::sum, by the
/// rows that they went along.
void sum_joints(const SolverIsland& island, double hs, JointPass pass);
/// How softly joints of precise islands close for sub-steps of `hs`.
Softness joint_softness(double hs);
/// Writes the impulses back to the joints, and their sums; gives the greatest velocity left in a
/// row [m/s, rad/s].
double store_joints(const SolverContext& context, const SolverIsland& island, double hs);

}  // namespace tumble
