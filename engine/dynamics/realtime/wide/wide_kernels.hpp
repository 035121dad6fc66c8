#pragma once
#include "engine/dynamics/realtime/joint_pass.hpp"
#include "engine/dynamics/realtime/tolerances.hpp"
#include "engine/dynamics/realtime/wide/wide_rows.hpp"

#include <cstdint>

namespace tumble {

/// The inner loops over bundles, in single precision, on the widest vectors of the machine. Lanes
/// are independent and nothing is fused or approximated, so that all machines give the same bits.
/// Each function processes bundles [begin, end); bundles of one colour may be processed
/// concurrently.
struct WideRange {
  uint32_t begin = 0, end = 0;
};

/// From staged values to rows: frames, lever arms, masses, impulses of the sub-step, bounce speeds.
void wide_prepare(WideRows& rows, WideRange contacts, const WideStep& step);
void wide_warm_start(WideRows& rows, WideRange contacts);
/// One sweep with bias.
void wide_solve(WideRows& rows, WideRange contacts, const WideStep& step);
/// One sweep without bias; adds the impulses to their sums.
void wide_relax(WideRows& rows, WideRange contacts, const WideStep& step);
/// As apply_restitution, whose result is stored in WideRows::blow_changes; that and `rebounds` must
/// have been resized.
void wide_bounce(WideRows& rows, WideRange contacts);
/// Greatest approach speed at a pressed point [m/s].
float wide_residual(WideRows& rows, WideRange contacts);

/// Masses of staged joints, and the first refresh.
void wide_prepare_joints(WideRows& rows, WideRange joints, const WideStep& step);
/// Arms, errors and effective masses at the present poses and velocities. Any joints may be
/// processed concurrently.
void wide_refresh_joints(WideRows& rows, WideRange joints, const WideStep& step);
void wide_warm_start_joints(WideRows& rows, WideRange joints, const WideStep& step, JointPass pass);
/// One sweep; the rows of a joint are solved at once.
void wide_solve_joints(WideRows& rows, WideRange joints, JointPass pass);
/// The same for joints with `struck` only, in any but the correcting pass.
void wide_solve_struck_joints(WideRows& rows, WideRange joints, JointPass pass);
/// Adds the impulses before the bodies moved (pass `moving`), or those after it, to the sums;
/// before the arms change.
void wide_sum_joints(WideRows& rows, WideRange joints, JointPass pass);
/// Greatest velocity left in a row [m/s, rad/s].
float wide_joint_residual(WideRows& rows, WideRange joints);

/// Changes the velocities of bundles of bodies by gravity, forces and torques over a sub-step.
void wide_kick(WideRows& rows, WideRange motions, float hs);
/// The same, and applies the impulses since the last kick once more.
void wide_kick_again(WideRows& rows, WideRange motions, float hs);
/// Moves positions and orientations; rotation by the midpoint rule, which conserves angular
/// momentum.
void wide_move(WideRows& rows, WideRange motions, float hs);

}  // namespace tumble
