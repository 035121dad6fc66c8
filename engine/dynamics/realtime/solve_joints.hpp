#pragma once
#include "engine/dynamics/realtime/joint_pass.hpp"
#include "engine/dynamics/realtime/solver_rows.hpp"

#include <vector>

namespace tumble {

/// Joints in the sub-steps of the realtime solver, by RATTLE (Andersen 1983): impulses along the
/// Jacobian at the start of the sub-step make its end satisfy the joint; then impulses along the
/// Jacobian at its end make velocities satisfy it. Both are warm-started separately. In ordinary
/// islands the impulses that correct earlier position errors are not warm-started: they would
/// integrate the error that unconverged sweeps leave, and excite slow modes of a mechanism without
/// bound. Rows of one joint are solved together, joints one after the other in the order of their
/// ids. What acts along the coordinates of a joint (drive_row.hpp) has rows behind the kept ones:
/// each is one scalar problem with the compliance that the kept rows leave, so that a motor does
/// not work against its own hinge; several of them are solved one after the other, in a few sweeps.

/// Appends the rows of what acts along the coordinates of a joint; the rows of its island begin at
/// index `first`.
void add_drives(const Joint& from, size_t first, JointBlock& joint, std::vector<DriveRow>& drives);

/// Fills in the blocks, which come with a, b and source set; bodies must be prepared.
void prepare_joints(const SolverContext& context, const SolverIsland& island, double hs);
/// Computes rows and effective masses at the present poses and velocities.
void refresh_joints(const SolverContext& context, const SolverIsland& island, double hs);

/// Starts a pass: sets the force laws of coordinates and applies the impulses of the previous
/// sub-step, except where bodies turn too far (max_turn_per_substep).
void warm_start_joints(const SolverIsland& island, double hs, JointPass pass);
/// The sweeps of a precise island before the bodies move, and after it. Before it all sweeps are
/// correcting ones, and their impulses are warm-started: so many sweeps leave little of any mode.
void move_onto_joints(const SolverIsland& island, double hs);
void relax_joints(const SolverIsland& island, double hs);

// An armature is as fast as its coordinate when a tick begins. Contacts that are solved after the
// joints change the coordinate alone: at the end of a tick the armature must follow, or it would
// get that speed for nothing in the next.

/// Whether anything along a coordinate has inertia of its own.
bool has_armature(const SolverIsland& island);
/// To be called after the last sweep over contacts of a tick.
void follow_with_armatures(const SolverIsland& island, double hs);

// The parts of these, for islands of which only some joints are solved here.

/// A range of the sweeps of a pass.
void sweep_joints(const SolverIsland& island, double hs, JointPass pass, JointSweeps which);
/// Adds the impulses before the bodies moved (pass `moving`), or those after it, to
/// JointBlock::sum, along the rows with which they were applied.
void sum_joints(const SolverIsland& island, double hs, JointPass pass);
/// Softness with which joints of precise islands close in sub-steps of `hs`.
Softness joint_softness(double hs);
/// Writes the impulses and their sums back to the joints; returns the greatest velocity left in a
/// row [m/s, rad/s].
double store_joints(const SolverContext& context, const SolverIsland& island, double hs);

}  // namespace tumble
