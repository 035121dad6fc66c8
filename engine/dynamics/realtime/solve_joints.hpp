#pragma once
#include "engine/dynamics/realtime/joint_pass.hpp"
#include "engine/dynamics/realtime/solver_rows.hpp"

#include <vector>

namespace tumble {

/// Sub-steps of joints in the realtime solver. A sub-step is that of RATTLE (Andersen 1983):
/// impulses along the Jacobian of its start so that its end is on the joint, then impulses along
/// the Jacobian of its end so that velocities are too; both are warm-started on their own. Rows of
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
/// SolverIsland::joint_sweeps sweeps, there and back. `stiffness` is that of the moving pass,
/// as factors of the soft step.
void solve_joints(const SolverIsland& island, double hs, const Softness& stiffness, JointPass pass);

// What solve_joints is made of, for islands of which only a part is in these rows.

/// The sweeps alone.
void sweep_joints(const SolverIsland& island, double hs, const Softness& stiffness, JointPass pass);
/// Whether a limit that bounces may be met: the moving pass is solved without such limits first.
bool nears_limit(const SolverIsland& island);
/// These limits take part from here on.
void put_limits(const SolverIsland& island, double hs);
/// The greatest change of a blow on a limit since this was asked last, as a share of it; 0 when
/// none bounces.
double blow_change(const SolverIsland& island);

// Impulses of a sub-step in which there was a blow say nothing of the next one, which would give
// it again: that one starts from those before.

/// Whether a limit gave back a blow in the last relaxing pass; then impulses were remembered before
/// the limit was met.
bool limit_bounces(const SolverIsland& island);
void remember_impulses(const SolverIsland& island);
void recall_impulses(const SolverIsland& island);

/// As note_speeds and taken_by_contacts, of the kept rows: what the other rows of an island leave
/// to them.
void note_joint_speeds(const SolverIsland& island);
double taken_by_joints(const SolverIsland& island, JointPass pass);
/// Before contacts bounce, and to leave no more than this share of what joints gave to that.
void remember_relaxing(const SolverIsland& island);
void scale_bounces(const SolverIsland& island, double share);

/// Adds the impulses of a pass to JointBlock::sum, by the rows that they went along.
void sum_joints(const SolverIsland& island, double hs, JointPass pass);
/// How stiff joints are for sub-steps of `hs`.
Softness joint_softness(double hs);
/// Writes the impulses back to the joints, and their sums; gives the greatest velocity left in a
/// row [m/s, rad/s].
double store_joints(const SolverContext& context, const SolverIsland& island, double hs);

}  // namespace tumble
