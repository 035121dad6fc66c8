#pragma once
#include "engine/dynamics/realtime/joint_pass.hpp"
#include "engine/dynamics/realtime/tolerances.hpp"
#include "engine/dynamics/realtime/wide/wide_rows.hpp"

#include <cstdint>

namespace tumble {

/// The inner loops over bundles, single precision, on the widest vectors that the machine
/// has. Lanes never mix and nothing is fused or approximated, so that all machines get the same
/// bits. Each takes bundles [begin, end); those of one colour may be worked on at once.
struct WideRange {
  uint32_t begin = 0, end = 0;
};

/// Turns what was staged into rows: frames, lever arms, masses, impulses of the sub-step, bounces.
void wide_prepare(WideRows& rows, WideRange contacts, const WideStep& step);
void wide_warm_start(WideRows& rows, WideRange contacts);
/// One sweep that works off penetration.
void wide_solve(WideRows& rows, WideRange contacts, const WideStep& step);
/// One sweep without bias, and the sums of impulses.
void wide_relax(WideRows& rows, WideRange contacts, const WideStep& step);
/// As apply_restitution, whose result is left in WideRows::blow_changes; these and the rebounds
/// have been made.
void wide_bounce(WideRows& rows, WideRange contacts);
/// Greatest approach speed at a pressed point [m/s].
float wide_residual(WideRows& rows, WideRange contacts);

/// Masses of what was staged, and the first refresh.
void wide_prepare_joints(WideRows& rows, WideRange joints, const WideStep& step);
/// Arms, errors and effective masses at the present poses and velocities. Any joints at once.
void wide_refresh_joints(WideRows& rows, WideRange joints, const WideStep& step);
void wide_warm_start_joints(WideRows& rows, WideRange joints, const WideStep& step, JointPass pass);
/// One sweep; all rows of a joint at once.
void wide_solve_joints(WideRows& rows, WideRange joints, JointPass pass);
/// The same of those that are struck, in any pass but the correcting one.
void wide_solve_struck_joints(WideRows& rows, WideRange joints, JointPass pass);
/// Adds the impulses before the bodies moved (`moving`), or after that, to the sums; before the
/// arms change.
void wide_sum_joints(WideRows& rows, WideRange joints, JointPass pass);
/// Greatest velocity left in a row [m/s, rad/s].
float wide_joint_residual(WideRows& rows, WideRange joints);

/// Velocities of bundles of bodies: gravity, forces and torques over a sub-step.
void wide_kick(WideRows& rows, WideRange motions, float hs);
/// The same, and once more the impulses that came since the last kick.
void wide_kick_again(WideRows& rows, WideRange motions, float hs);
/// Their positions; rotation by the midpoint rule, which keeps angular momentum.
void wide_move(WideRows& rows, WideRange motions, float hs);

}  // namespace tumble
