#pragma once
#include <cstddef>
#include <cstdint>

/// Constants of this folder that are no settings: unit, reason, and source where there is one. A
/// dimensionless share is relative to the quantity that the comment names.
namespace tumble::tolerances {

// Closed, resting, sliding.

/// Surfaces nearer than this touch [m]: a millionth of a millimetre, and a million times the
/// rounding error of positions near the origin.
inline constexpr double touch_distance = 1e-9;
/// A contact that is closed may be as far off as this before it counts as open [m]; a step is
/// accepted if it leaves no more than half of this, and half of still_speed.
inline constexpr double closed_distance = 100 * touch_distance, kept_closed_share = 0.5;
/// Slower normal velocity counts as zero: the contact is closed, without restitution [m/s]. Such a
/// bounce rises by 5e-14 m against gravity.
inline constexpr double still_speed = 1e-6;
/// Slower slip counts as sticking [m/s]; slip slower than the second has no reliable direction.
inline constexpr double sticking_speed = 1e-6, no_slip_speed = 1e-9;
/// Slower relative rotation counts as zero where materials resist it [rad/s]: half a degree in
/// three hours. Rotation slower than the second has no reliable direction.
inline constexpr double still_turning = 1e-6, no_turning = 1e-9;
/// An open contact that touches and approaches faster than this collides [m/s].
inline constexpr double collision_speed = 1e-9;
/// Rounding error of positions: a constant [m], and a share of the distance from the origin.
/// Contacts that would bounce lower than this stay closed.
inline constexpr double place_rounding = 1e-12, place_rounding_share = 1e-14;
/// Impacts of one contact in a tick [-] after which it comes to rest if it approaches slower than
/// this share of gravity times the tick (Zeno): a bounce would then last at most a quarter of the
/// tick.
inline constexpr int many_impacts = 8;
inline constexpr double zeno_of_gravity_tick = 0.125;
/// Forces this close to the surface of the friction cone, relatively, are on it [-].
inline constexpr double on_cone = 1e-9;
/// Greatest number of contacts of connected bodies whose problem is shown to people as a whole [-]:
/// its matrix is dense, and nobody reads a larger one.
inline constexpr size_t most_posed_contacts = 100;

// Contact points.

/// How much contacts may overlap beyond their accepted depth before a step is taken back [m];
/// overlap from which on a pair must have a contact; and overlap beyond which something passed
/// unwatched.
inline constexpr double deepest_unseen = 1e-8, seen_depth = 0.5 * deepest_unseen,
                        came_through = 2 * deepest_unseen;
/// Greater than any length or other value that it is compared with: stands for no limit.
inline constexpr double no_limit = 1e300;
/// Gap below which the normal of two corners is undefined [m], since its digits are lost in the
/// rounding of their positions.
inline constexpr double corners_touch = 1e-6;
/// Two points whose depths differ by less are equally deep [m]: twice touch_distance.
inline constexpr double same_depth = 2e-9;
/// Greatest overlap of pieces of meshes that have only just come to touch [m]: a hundred times what
/// a step lets through.
inline constexpr double just_in = 1e-6;
/// A pair keeps no older contacts once it has this many [-]: three manifolds.
inline constexpr size_t most_kept_contacts = 12;
/// As shares of the smaller shape's size: distance at which two points are the same, gap up to
/// which older contacts are kept, how far a crossing of edges may move in a step, and how far
/// beyond the ends of the edges it may be [-].
inline constexpr double same_place_of_size = 1e-6, kept_gap_of_size = 1e-3,
                        far_along_of_size = 0.25, far_off_of_size = 1e-2;
/// Distance from a rim, as a share of its radius, at which a point lies on it [-].
inline constexpr double on_rim_of_radius = 1e-3;
/// As shares of the size: how much farther than the nearest point another may be to count as
/// nearest; and, with a share of the gap, how much the gap of elements may differ from that of the
/// narrow phase [-].
inline constexpr double nearest_of_size = 1e-9, same_gap_of_size = 1e-7, same_gap_of_gap = 1e-3;
/// Contacts are sought up to a gap of the distance that bodies may travel, plus this [m], but no
/// more than this share of the smaller one's radius [-].
inline constexpr double contact_margin = 1e-4, margin_of_size = 0.5;

// Gaps of shapes and pieces.

/// As shares of the size: gap beyond which nearest points give the normal, how far B is moved apart
/// to find it otherwise, and rounding error of a separation [-].
inline constexpr double nearest_points_of_size = 1e-3, lift_of_size = 1e-2,
                        separation_rounding = 1e-15;
/// Change of a unit normal at which it counts as converged, and most iterations [-]: two or three
/// usually suffice.
inline constexpr double same_direction = 1e-13;
inline constexpr int most_lifts = 12;
/// Greatest squared length of the component of a unit direction across a half-space's normal at
/// which the two are parallel [-].
inline constexpr double along_normal2 = 1e-12;
/// The closed form is used where a ball's centre is this far outside of the other shape, as a share
/// of its radius [-].
inline constexpr double clearly_out_of_radius = 1e-3;
/// As shares of the size: gap of pieces below which face normals are tried too; and how far nearest
/// pieces are sought where an estimate of their gap found none, and the factor by which that grows
/// each time [-].
inline constexpr double touch_zone_of_size = 1e-3, first_reach_of_size = 1e-3, reach_growth = 10;
/// As a share of both sizes: rounding error of a tree's boxes, which are in single precision; and
/// relative error of rotated axes of a box in double precision [-].
inline constexpr double box_rounding_of_size = 1e-6, axis_rounding = 1e-14;

// Looks between two moments.

/// Overlap between two sampled times that may pass unseen [m]; for small bodies, this share of the
/// size.
inline constexpr double deepest_dip = 5e-6, dip_of_size = 1e-4;
/// The greater of the angular speeds at both ends of a step, times this, bounds those between [-].
inline constexpr double swing_spare = 1.25;
/// Distance of the axis of revolution from the centre of mass, as a share of the radius, that is
/// rounding error [-].
inline constexpr double round_axis_of_radius = 1e-12;
/// Number of times per step at which gaps and slips are sampled; most halvings of an interval to
/// exclude a touch in it [-].
inline constexpr int looks_per_step = 8, most_divisions = 14;
/// Where a gap has just opened it is sampled at ever shorter times, each this share of the one
/// before, down to this share of the step [-].
inline constexpr double probe_factor = 0.25, least_probe = 1e-15;
/// Relative accuracy of a root in time, and most iterations [-]: regula falsi needs ten, bisection
/// 52.
inline constexpr double root_accuracy = 1e-16;
inline constexpr int most_root_steps = 80;
/// Accuracy of the depth at which a touch is located, as a share of deepest_unseen [-].
inline constexpr double touch_root_share = 0.01;
/// Safety factor of bounds on how far bodies come in a step; contacts up to this many times that
/// distance are watched [-].
inline constexpr double reach_spare = 1.1, watched_reaches = 2;

// Steps.

/// Most halvings of a step to make it exact, after which it is accepted [-]: occasionally, where
/// points and edges of triangles pass over each other, closed contacts separate at a rate that no
/// shorter step reduces; the error is projected away after the step.
inline constexpr int most_exact_tries = 12;
/// As shares of a tick: an event nearer than this happens now, and no shorter step is tried; a step
/// that ends this near to the end of the tick ends there. As a share of a step: an event this near
/// to its end is at its end [-].
inline constexpr double shortest_step = 1e-9, tick_end = 1e-12, step_end = 1e-10;
/// Greatest product of the step and the bound on the rates of springs [-]: the classical
/// Runge-Kutta method is stable up to 2.8, the semi-implicit Euler method up to 2.
inline constexpr double swing_per_step = 2;
/// Greatest rotation of a body in a step [rad]: the error, of fourth order, is then a thousandth of
/// a milliradian.
inline constexpr double turn_per_step = 0.25;
/// Ratio of moments of inertia from which on a body counts as a needle; and rotation of the
/// thinnest bodies about their axis in a step, in multiples of turn_per_step times the square root
/// of that ratio [-].
inline constexpr double ordinary_moment_ratio = 10, thinnest_turns = 13;
/// How far other bodies may pass in a step, as a share of a body's inner radius; and the least
/// inner radius that counts, as a share of its bounding radius [-].
inline constexpr double passed_of_inner = 0.25, least_inner_of_size = 0.05;
/// Integrators of at least this order are accurate: their steps are judged by the errors of joints
/// [-].
inline constexpr int accurate_order = 4;
/// Joints that open farther in a step show that it was too long [m, rad].
inline constexpr double open_per_step = 1e-6;
/// So do velocities that violate joints (as a share of kinetic energy: the square of a share of
/// velocity), and energy that is created or lost, since joints do no work (as a share). If the
/// shortest step still changes more than the third share of the energy, no way to continue exists
/// [-].
inline constexpr double changed_per_step = 1e-12, lost_per_step = 1e-6, lost_for_good = 1e-4;
/// Rounding error of energy: a share of all of it [-], and [J].
inline constexpr double energy_rounding = 1e-13, no_energy = 1e-20;
/// Slip that decelerates by more than this share of what friction could do ends before it becomes
/// stiff; and the least cosine between directions of the same slip [-].
inline constexpr double slowing_of_friction = 0.1, same_slip_cosine = 0.1;
/// Rate of friction against slow slip, times the step, from which on it is treated as stiff [-]:
/// explicit integrators are unstable at two.
inline constexpr double stiff_rate = 0.5;

// What is put right after a step.

/// Velocities [m/s] and distances [m] below which nothing is corrected: rounding errors in a tick,
/// which are corrected once they add up.
inline constexpr double rounding_speed = 1e-12, rounding_distance = 1e-13;
/// Error at which joints count as closed [m, rad], and most iterations [-]: convergence is
/// quadratic.
inline constexpr double closed_joint = 1e-13;
inline constexpr int most_projections = 8;
/// If joints opened by less, their rows are nearly those of the closed joints, and one
/// factorisation serves for the correction of positions and of velocities [m, rad]. The relative
/// error that this leaves is corrected in the next step (chord method).
inline constexpr double same_rows = 1e-6;
/// If an iteration leaves more than this share of the opening, the rows have changed too much for
/// that, as near dead points and in mechanisms of micrometres [-].
inline constexpr double chord_contraction = 0.1;
/// Most iterations of the correction of contacts [-]: one suffices, unless overlap is worked off.
inline constexpr int most_close_ups = 4;
/// Conjugate residuals end where the square of the residual is this share of the first one, where
/// an impulse has less than this share of the effect of one on the most mobile row, or after so
/// many iterations plus so many per row [-]; in exact arithmetic, one per row.
inline constexpr double residual_goal2 = 1e-30, without_effect = 1e-14;
inline constexpr ptrdiff_t residual_steps = 50, residual_steps_per_row = 10;
/// Residual that is accepted from points which depend on each other although the solver aims at
/// less; and residuals of problems of many unknowns that do not justify factorising their matrix,
/// of forces and of impulses (an error of still_speed for an approach at 10 m/s) [-].
inline constexpr double believable_residual = 1e-6, force_residual_of_many = 1e-8,
                        impulse_residual_of_many = 1e-7;

// Groups and windows.

/// Greatest number of bodies that may share the steps of others without being tied to them; and how
/// many times this number of bodies must be tied for it not to matter [-]: tied bodies must take
/// the steps of all their events anyway.
inline constexpr size_t untied_bodies = 4, tied_to_stranger = 2;
/// Added to a reach: a share of the body's bounding radius [-], and a length [m].
inline constexpr double reach_of_size = 0.01, least_reach = 1e-4;
/// EventSettings::budget where time-stepping is not available [-]: seconds of computing.
inline constexpr int patient_budget = 20000;
/// Factors on the reaches of bodies in a crowd, which hit each other and become faster, in a tick
/// and in a window; and on the distance that a body went, for its next reach [-].
inline constexpr double group_spare = 4, group_surplus = 1.25, crowd_spare = 2,
                        window_surplus = 1.0625;
/// Ticks that are time-stepped without an attempt by events, after the first failure and at most
/// [-].
inline constexpr uint8_t first_waited_ticks = 4, most_waited_ticks = 32;
/// Share of the budget that may be spent on the first attempt after ticks that were time-stepped
/// [-]: events that need more would soon exceed it again.
inline constexpr double retried_share = 0.25;
/// How often a tick may be halved [-]: windows are then four microseconds long.
inline constexpr int most_window_halvings = 12;
/// A crowded cluster that takes more steps than this goes through the window in two halves [-].
inline constexpr uint64_t few_steps = 8;
/// Gaps are computed up to this multiple of the distance that matters, so that the result can be
/// used longer [-].
inline constexpr double looks_ahead = 4;
/// How far projections may move bodies between windows [m].
inline constexpr double between_windows = 1e-6;

// Impulses.

/// Approach that counts as none, relative to the fastest velocity [-].
inline constexpr double rest_of_fastest = 1e-12;
/// Most collisions per point, or rounds of all points; rounds after which a series may be cut
/// short, and the approach that may be left then, relative to the first: a millionth of the energy
/// [-].
inline constexpr int most_rounds = 1000, long_series = 50;
inline constexpr double left_of_series = 1e-3;
/// Most sweeps for friction under given normal impulses, and the change, relative to the fastest
/// velocity, that ends them [-].
inline constexpr int most_sweeps = 20000;
inline constexpr double sweep_change = 1e-13;
/// Reduction of restitution that is rounding error [-].
inline constexpr double scale_rounding = 1e-12;
/// Collision at one point: most pieces of the process; slip that counts as none, relative to the
/// first velocity, and its relative growth with each piece, since rounding can keep slip alive;
/// first piece, relative to the impulse that stops the point; error of a piece, relative to the
/// first velocity [-].
inline constexpr int most_impact_pieces = 4000;
inline constexpr double no_slip_of_first = 4e-13, more_with_each_piece = 0.01, first_piece = 0.1,
                        piece_error = 1e-13;
/// A piece whose error is too large is shortened by the first factor; the next one is lengthened by
/// the third if the error is less than the second of what is allowed [-].
inline constexpr double shorter_piece = 0.6, accurate_piece = 1e-3, longer_piece = 1.5;
/// Rounding errors: of velocities, relative to the first; of a determinant; of the rate at which
/// slip turns; of the place of an event in a piece, with the most iterations to find it [-].
inline constexpr double recompression_rounding = 1e-14, singular_mobility = 1e-14,
                        straight_slip = 1e-15, piece_root = 1e-16;
inline constexpr int most_piece_root_steps = 100;
/// Number of directions among which those with straight growing slip are bracketed, and bisections
/// between two of them, which give all digits [-].
inline constexpr int slip_directions = 256, direction_halvings = 52;
/// Jams: slip slower than this counts as none [m/s]; approach that starts the process, relative to
/// the slip; change of slip that counts, relative to the fastest [-].
inline constexpr double jam_slip = 1e-8, jam_approach = 1e-9, jam_change = 1e-6;
/// Proof of a crush: most Newton steps, regularisation on the diagonal of their matrices, shortest
/// share of a step, and the relative gain that it must give; effect, relative to the impulses,
/// below which these cancel; approach that counts as none, relative to the fastest [-].
inline constexpr int most_proof_steps = 100;
inline constexpr double proof_yield = 1e-9, least_proof_step = 1e-6, proof_gain = 1e-12,
                        cancelled_share = 1e-3, no_approach_of_fastest = 1e-9;
/// Least impulse of the proof, relative to the greatest, at a body that is reported as crushed; and
/// how many are named [-].
inline constexpr double part_of_crush = 1e-2;
inline constexpr size_t most_crushed_names = 4;

}  // namespace tumble::tolerances
