#pragma once
#include <cstddef>
#include <cstdint>

/// The numbers of this room that no setting gives: unit, reason, and source where there is one.
/// Shares without a unit are of what the comment names.
namespace tumble::tolerances {

// Closed, resting, sliding.

/// Surfaces nearer than this touch [m]: a thousandth of what a microscope shows, and a million
/// roundings of places about the origin.
inline constexpr double touch_distance = 1e-9;
/// A contact that is closed may be as far off as this before it counts as open [m]; a step may
/// leave it off by half, of this and of still_speed.
inline constexpr double closed_distance = 100 * touch_distance, kept_closed_share = 0.5;
/// Slower along the normal is none: closed, no restitution [m/s]. Rises by 5e-14 m against gravity.
inline constexpr double still_speed = 1e-6;
/// Slower slip is none [m/s]; slip slower than the second has no direction.
inline constexpr double sticking_speed = 1e-6, no_slip_speed = 1e-9;
/// Slower turning against each other is none where materials resist it [rad/s]: half a degree in
/// three hours. Turning slower than the second has no direction.
inline constexpr double still_turning = 1e-6, no_turning = 1e-9;
/// Faster approach of an open contact is a collision [m/s].
inline constexpr double collision_speed = 1e-9;
/// The digits of a place: a constant [m], and a share of its distance from the origin. What bounces
/// lower stays.
inline constexpr double place_rounding = 1e-12, place_rounding_share = 1e-14;
/// Impacts of one contact in a tick [-] after which it rests if it approaches slower than this
/// share of what gravity gives in a tick (Zeno): the series that is left would end in a quarter of
/// the tick.
inline constexpr int many_impacts = 8;
inline constexpr double zeno_of_gravity_tick = 0.125;
/// Of the friction cone: what is nearer to it is on it [-].
inline constexpr double on_cone = 1e-9;
/// Contacts of bodies that hang together, up to which their problem is posed as one for people to
/// look at [-]: its matrix is dense, and nobody follows more.
inline constexpr size_t most_posed_contacts = 100;

// Contact points.

/// What contacts may come in beyond their offset before a step is taken back [m]; overlap from
/// which on a contact must say so; and beyond which something came through that nobody watched.
inline constexpr double deepest_unseen = 1e-8, seen_depth = 0.5 * deepest_unseen,
                        came_through = 2 * deepest_unseen;
/// Greater than any length, or any other value that it stands for: there is none.
inline constexpr double no_limit = 1e300;
/// Gap below which two corners have no normal [m]: its digits are those of their places.
inline constexpr double corners_touch = 1e-6;
/// Difference at which two points are as deep [m]: twice touch_distance.
inline constexpr double same_depth = 2e-9;
/// Overlap up to which pieces of meshes have just come to touch [m]: a hundred times what a step
/// lets through.
inline constexpr double just_in = 1e-6;
/// Contacts of a pair from which on no older ones are kept [-]: three manifolds.
inline constexpr size_t most_kept_contacts = 12;
/// Of the size of the smaller shape: distance at which points are the same, gap up to which older
/// contacts are kept, how far a crossing of edges may run in a step, and how far beyond the ends of
/// edges it may be [-].
inline constexpr double same_place_of_size = 1e-6, kept_gap_of_size = 1e-3,
                        far_along_of_size = 0.25, far_off_of_size = 1e-2;
/// Of a rim's radius: distance at which a point lies on it [-].
inline constexpr double on_rim_of_radius = 1e-3;
/// Of the size: how much farther than the nearest point another may be to be as near; and by how
/// much, besides a share of the gap, elements may differ from what the narrow phase found [-].
inline constexpr double nearest_of_size = 1e-9, same_gap_of_size = 1e-7, same_gap_of_gap = 1e-3;
/// Gaps of interest: what bodies may come in the tick, and this [m], but no more than this share of
/// the smaller one's radius [-].
inline constexpr double contact_margin = 1e-4, margin_of_size = 0.5;

// Gaps of shapes and pieces.

/// Of the size: gap beyond which nearest points give the normal, how far B is moved away to find it
/// where they do not, and what a separation loses by rounding [-].
inline constexpr double nearest_points_of_size = 1e-3, lift_of_size = 1e-2,
                        separation_rounding = 1e-15;
/// Difference of unit normals that is none, and moves to get there [-]: most need two or three.
inline constexpr double same_direction = 1e-13;
inline constexpr int most_lifts = 12;
/// Square of what a unit direction may lack of a half-space's normal to be along it [-].
inline constexpr double along_normal2 = 1e-12;
/// How far outside a ball's centre is of what it meets, of its radius, for a closed form [-].
inline constexpr double clearly_out_of_radius = 1e-3;
/// Of the size: gap of pieces below which the normals of faces are tried too; and how far the
/// nearest pieces are sought where a bound of their gap found none, and how much farther each time
/// [-].
inline constexpr double touch_zone_of_size = 1e-3, first_reach_of_size = 1e-3, reach_growth = 10;
/// Of the sizes of both: by how much boxes may be off, which trees keep in single precision; and of
/// one: axes of a box that were turned, in double precision [-].
inline constexpr double box_rounding_of_size = 1e-6, axis_rounding = 1e-14;

// Looks between two moments.

/// What a dip between two looks at a pair may hide [m]; of small bodies this share of the size.
inline constexpr double deepest_dip = 5e-6, dip_of_size = 1e-4;
/// The greater of the angular speeds at both ends of a step, times this, bounds those between [-].
inline constexpr double swing_spare = 1.25;
/// Distance of the axis of a round shape from the centre, of the radius, that is rounding [-].
inline constexpr double round_axis_of_radius = 1e-12;
/// Looks per step, at which gaps and slips are sampled; halvings of the time between two of them to
/// clear a touch [-].
inline constexpr int looks_per_step = 8, most_divisions = 14;
/// What has just parted is looked for at ever shorter times, each this share of the one before,
/// down to this share of the step [-].
inline constexpr double probe_factor = 0.25, least_probe = 1e-15;
/// A root of time to all its digits, and the most steps to get there [-]: regula falsi needs ten,
/// halving 52.
inline constexpr double root_accuracy = 1e-16;
inline constexpr int most_root_steps = 80;
/// Depth at which a touch is found, of deepest_unseen [-].
inline constexpr double touch_root_share = 0.01;
/// Spare of bounds on how far bodies come in a step; and contacts as far as this many of them are
/// looked at [-].
inline constexpr double reach_spare = 1.1, watched_reaches = 2;

// Steps.

/// Halvings of a step that is to be exact, after which it is taken as it is [-]: now and then,
/// where points and edges of triangles run over each other, closed contacts part at a rate that no
/// step makes smaller, and which is put right after it.
inline constexpr int most_exact_tries = 12;
/// Of a tick: an event that is nearer happens now, and no shorter step is tried; a step that ends
/// so near its end ends there. Of a step: an event so near its end is its end [-].
inline constexpr double shortest_step = 1e-9, tick_end = 1e-12, step_end = 1e-10;
/// What springs do to a body in a step, as a bound on their rates says [rad, of damping -]: the
/// classical Runge-Kutta method holds rates of up to 2.8, the semi-implicit one of up to 2.
inline constexpr double swing_per_step = 2;
/// Turn of a body in a step [rad]: the error of fourth order is a thousandth of a milliradian.
inline constexpr double turn_per_step = 0.25;
/// Ratio of moments of inertia from which on a body is a needle; and turn about its axis of the
/// thinnest in multiples of turn_per_step, times the root of that ratio [-].
inline constexpr double ordinary_moment_ratio = 10, thinnest_turns = 13;
/// Of the inner radius of a body: how far others may come in a step; of its radius: the least inner
/// radius that counts [-].
inline constexpr double passed_of_inner = 0.25, least_inner_of_size = 0.05;
/// Order from which on an integrator is accurate: its steps are judged by what joints tell [-].
inline constexpr int accurate_order = 4;
/// Joints that come open farther in a step tell that it was too long [m, rad].
inline constexpr double open_per_step = 1e-6;
/// So do velocities that leave what joints let through, since what is off along with it is as much
/// (the square of a share); and energy that comes or goes, since joints do no work (a share) [-].
/// More in the shortest step than the third, and there is no way on.
inline constexpr double changed_per_step = 1e-12, lost_per_step = 1e-6, lost_for_good = 1e-4;
/// Energy that is none: a share of all of it [-], and [J].
inline constexpr double energy_rounding = 1e-13, no_energy = 1e-20;
/// Slip that is braked by more than this part of what friction could do is over before it is
/// stiff; and the cosine of the direction from which on it is still the same slip [-].
inline constexpr double slowing_of_friction = 0.1, same_slip_cosine = 0.1;
/// Rate of friction against slow slip, times the step, from which on it is stiff [-]: explicit
/// integrators blow up at two.
inline constexpr double stiff_rate = 0.5;

// What is put right after a step.

/// What the digits of forces and places leave in a tick is put right when it adds up [m/s], [m].
inline constexpr double rounding_speed = 1e-12, rounding_distance = 1e-13;
/// Error at which joints count as closed [m, rad], and the most steps to get there [-]: each
/// squares the error.
inline constexpr double closed_joint = 1e-13;
inline constexpr int most_projections = 8;
/// Opened by less, joints have the rows that they have closed: one factorisation serves for the way
/// there and the velocities [m, rad]. What it is off by, this much of what is put right, the next
/// step takes (chord method).
inline constexpr double same_rows = 1e-6;
/// Where a step left more than this share of what joints had opened by, the rows have changed too
/// much for that, as near dead points and in mechanisms of micrometres [-].
inline constexpr double chord_contraction = 0.1;
/// Steps in which contacts are put right [-]: one, and more where overlap is worked off.
inline constexpr int most_close_ups = 4;
/// Conjugate residuals end where the square of the rest is this share of the first, or an impulse
/// does no more than this share of what the stiffest row does, or after so many steps and so many
/// for each row [-]: in exact numbers, one for each row.
inline constexpr double residual_goal2 = 1e-30, without_effect = 1e-14;
inline constexpr ptrdiff_t residual_steps = 50, residual_steps_per_row = 10;
/// Residual that points which depend on each other may leave where a solver aims at less; and that
/// of many unknowns which is not worth a factorisation of their matrix, of forces and of impulses
/// (of an approach of 10 m/s less than what counts as closed) [-].
inline constexpr double believable_residual = 1e-6, force_residual_of_many = 1e-8,
                        impulse_residual_of_many = 1e-7;

// Groups and windows.

/// Bodies that may move with others, as finely as these, that nothing ties them to; and that many
/// times they must be those that are tied [-]: what is tied goes the way of its own events anyway.
inline constexpr size_t untied_bodies = 4, tied_to_stranger = 2;
/// Added to a reach: a share of the body's size [-], and [m].
inline constexpr double reach_of_size = 0.01, least_reach = 1e-4;
/// EventSettings::budget where there is no other way than events [-]: seconds of computing.
inline constexpr int patient_budget = 20000;
/// Factors on the reaches of bodies in a crowd, who hit each other and then go faster, in a tick
/// and in a window; and on how far a body went, for its next reach [-].
inline constexpr double group_spare = 4, group_surplus = 1.25, crowd_spare = 2,
                        window_surplus = 1.0625;
/// Ticks that are time-stepped without a try after the first that failed, and at most [-].
inline constexpr uint8_t first_waited_ticks = 4, most_waited_ticks = 32;
/// Share of the budget that may be spent on the tick in which events are tried again after ticks
/// that were time-stepped [-]: where they take more, they are soon too much again.
inline constexpr double retried_share = 0.25;
/// How often a tick may be halved [-]: to four microseconds.
inline constexpr int most_window_halvings = 12;
/// A crowded cluster that takes more steps than this goes through the window in two halves [-].
inline constexpr uint64_t few_steps = 8;
/// Gaps up to this many reaches are measured [-].
inline constexpr double looks_ahead = 4;
/// What projections may move bodies between windows [m].
inline constexpr double between_windows = 1e-6;

// Impulses.

/// Approach that is none, of the fastest velocity [-].
inline constexpr double rest_of_fastest = 1e-12;
/// Collisions of a point, or rounds of all; rounds after which a series may be cut short, and
/// approach that may be left then, of the first: a millionth of the energy [-].
inline constexpr int most_rounds = 1000, long_series = 50;
inline constexpr double left_of_series = 1e-3;
/// Sweeps for friction under given normal impulses, and the change, of the fastest velocity, that
/// ends them [-].
inline constexpr int most_sweeps = 20000;
inline constexpr double sweep_change = 1e-13;
/// Share of restitution that rounding took [-].
inline constexpr double scale_rounding = 1e-12;
/// One point: pieces of the way; slip that is none, of the first velocity, and how much more of it
/// with each piece since rounding can keep slip alive; first piece, of what stops the point; error
/// of a piece, of the first velocity [-].
inline constexpr int most_impact_pieces = 4000;
inline constexpr double no_slip_of_first = 4e-13, more_with_each_piece = 0.01, first_piece = 0.1,
                        piece_error = 1e-13;
/// A piece is shortened by the first where its error is more, and the next is longer by the third
/// where it is less than the second of it [-].
inline constexpr double shorter_piece = 0.6, accurate_piece = 1e-3, longer_piece = 1.5;
/// Roundings: of velocities, of the first; of a determinant; of a rate of turning; of the place of
/// an event in a piece, and the most steps to find it [-].
inline constexpr double recompression_rounding = 1e-14, singular_mobility = 1e-14,
                        straight_slip = 1e-15, piece_root = 1e-16;
inline constexpr int most_piece_root_steps = 100;
/// Directions among which those are sought in which slip grows straight, and halvings between two
/// of them, which give all digits [-].
inline constexpr int slip_directions = 256, direction_halvings = 52;
/// Jams: a point slower than this does not slide [m/s]; approach that starts the process, of the
/// slip; change of slip that counts, of the fastest [-].
inline constexpr double jam_slip = 1e-8, jam_approach = 1e-9, jam_change = 1e-6;
/// Proof of a crush: Newton's steps, what is added to the diagonal of their matrices, the shortest
/// share of one, and what it must gain of that; what impulses that cancel leave of their effects;
/// approach that is none, of the fastest [-].
inline constexpr int most_proof_steps = 100;
inline constexpr double proof_yield = 1e-9, least_proof_step = 1e-6, proof_gain = 1e-12,
                        cancelled_share = 1e-3, no_approach_of_fastest = 1e-9;
/// Impulse of a proof, of the greatest, of a body that is crushed; and how many are named [-].
inline constexpr double part_of_crush = 1e-2;
inline constexpr size_t most_crushed_names = 4;

}  // namespace tumble::tolerances
