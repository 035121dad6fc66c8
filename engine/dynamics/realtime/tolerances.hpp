#pragma once
#include <cstddef>
#include <cstdint>

/// The numbers of this room that no setting gives: unit, reason, and source where there is one.
namespace tumble::tolerances {

// How an island is solved.

/// Contact points times sub-steps that a precise island may cost in a tick: as much as one of 512
/// points with all of its 16. [-]
inline constexpr size_t precise_budget = 8192;
/// Joints times sweeps, likewise, and the most sweeps of all. [-]
inline constexpr size_t joint_budget = 512, most_joint_sweeps = 8;
/// Sweeps over the joints of an ordinary island in each pass [-]: there and back, so that no end of
/// a chain is favoured.
inline constexpr int ordinary_joint_sweeps = 2;
/// Islands of so few points are always precise: all of their sub-steps cost less than the looks for
/// their contacts. Four boxes in a row, a double pendulum. [-]
inline constexpr size_t negligible_work = 16;
/// Share of its inner radius that a body may sink in where sub-steps are ordinary [-]. Cubes of a
/// metre and balls of half a metre across are below it with 240 sub-steps a second, and stand in
/// towers of ten; what is ten times smaller is not. Found with the accuracy cases A1 and A10.
inline constexpr double allowed_sink = 1e-3;
/// Ratio of masses that a joint of an ordinary island bears [-]: that of a torso and its forearm is
/// ten.
inline constexpr double borne_mass_ratio = 30;
/// A body with more contacts than this may leave some without a colour (Colouring: one colour less
/// than twice the contacts of a body are enough). [-]
inline constexpr uint16_t coloured_contacts = 16;
/// Square of an anchor's distance over that of gyration from which on single precision cannot tell
/// the rows of a joint apart [-]: three of its seven digits are left.
inline constexpr double single_precision_arm = 1e4;

// Contacts and joints.

/// Turn of a body in a tick from which on lever arms follow it [rad]: an arm is off by a fifth of
/// its length by then.
inline constexpr double arms_follow_turn = 0.2;
/// Distance of an anchor from the centre, relative to the rounding, that is rounding [-].
inline constexpr double on_round_surface = 1e-9;
/// Greatest frequency of contacts and of joints, of the rate of sub-steps [-]. Joints and hard
/// contacts have a quarter, the bound of Box2D 3.0 (Catto 2024), above which they ring.
inline constexpr double contact_frequency_share = 0.125;
inline constexpr double joint_frequency_share = 0.25;
/// Damping of joints, of critical [-]: as in Box2D 3.0 (Catto 2024). With this and the frequency a
/// sub-step works off 28 % of an error; with half of it a swinging chain of twenty links in an
/// ordinary island gained 2 J.
inline constexpr double joint_damping_ratio = 2;
/// Frequency of hard contacts (is_hard) in multiples of that of others [-]: as Box2D 3.0 has it
/// against what cannot move (Catto 2024).
inline constexpr double hard_contact_frequency = 2;
/// Pivot of a joint's effective mass, of its diagonal, below which the row depends on those before
/// it [-]: ten thousand roundings in double precision, sixteen in single.
inline constexpr double dependent_row = 1e-12;
inline constexpr float dependent_row_single = 1e-6f;
/// Turn of a body in a sub-step up to which joints follow it [rad]. Beyond it the impulses of the
/// sub-step before, which held each other in balance, push another way: where one alone would turn
/// such a body as fast again a joint starts without them. Joints between heavy bodies would else
/// throw a light one about, faster every time. Second derivatives of the joint's lines say nothing
/// of the end of such a sub-step either and are followed no farther.
inline constexpr double max_turn_per_substep = 0.3;
/// A joint that is not kept is brought together no faster than this along each of its rows [m/s],
/// [rad/s]: what was put together wrongly is corrected over ticks instead of being shot at. Joints
/// that are kept are off by millimetres, which are worked off at a hundredth of it.
inline constexpr double max_joint_correction = 10;
/// Sweeps over the coordinates of one joint each time that it is solved [-]: they are nearly at
/// right angles, so that three leave less than a hundredth.
inline constexpr int drive_sweeps = 3;
/// A coordinate that meets its limit more slowly than this does not bounce [m/s], [rad/s]: a
/// hundredth of what contacts need, as here nothing but the joint itself is in the way, and above
/// what twice the acceleration of a sub-step adds, which makes the last bounces end.
inline constexpr double limit_rest_speed = 0.01;
/// Bounces of bodies with joints are right to this share of their speed [-], a thousandth as of the
/// other rows of a precise island; each turn of bounces and joints takes away an eighth to a half
/// of what is missing.
inline constexpr double bounce_error = 1e-3;
/// Turns of bounces and joints at the end of a tick in which something bounced [-]: 2^-32 where a
/// half is left by each.
inline constexpr int most_bounce_turns = 32;
/// Strength of a damper over half of a sub-step below which the share of it that is implicit is
/// taken from the first term of its series [-]: the next one is a ten thousandth of it.
inline constexpr double weak_damper = 1e-4;

// Springs.

/// Share of an overlap that contacts beside springs work off in a sub-step [-]: the usual one of
/// Baumgarte's stabilisation (Catto 2005), below which nothing swings.
inline constexpr double rigid_share = 0.2;
/// Sub-step of islands with springs, at most [s]: backward Euler damps what swings faster than some
/// 40 Hz then.
inline constexpr double spring_substep = 1.0 / 240;
/// How much of the shortest spring's length the ends of springs and what touches may pass by in a
/// sub-step [-]: what a contact stops at the start of one has gone wrong by no more.
inline constexpr double passed_in_substep = 0.125;
/// Frequency of a spring alone with its ends, times sub-step [rad]: up to here a few tens of sweeps
/// solve a lump of springs.
inline constexpr double stiff_in_substep = 10;
/// Sub-steps that both may come to, at most [-].
inline constexpr double most_spring_substeps = 64;
/// Springs and contacts are solved in turn until a sweep changes the impulses of springs by less
/// than this share of what one has at most [-]. Lumps of 64 particles on 600 springs of 20 to 2e4
/// N/m that meet the ground or a ball then gain less than a hundredth of their energy.
inline constexpr double spring_error = 0.01;
/// Most and least sweeps of a sub-step over springs, and how many springs times sweeps it may have
/// in between [-]: 5 ms, on a cloth of 2,000 nodes 8 sweeps.
inline constexpr size_t most_spring_sweeps = 100, least_spring_sweeps = 8, spring_budget = 120000;

// Motion.

/// Square of the turn in a sub-step from which on the gyroscopic term is taken into account [rad2]:
/// below a milliradian it turns the angular velocity by no more than that.
inline constexpr double gyroscopic_turn2 = 1e-6;
/// Square of half the angle up to which sine and cosine are taken by four terms of their series
/// [rad2]: what is left out is below 1e-16.
inline constexpr double series_half_turn2 = 0.0025;
/// Iterations for the velocity at the middle of a step of rotation [-]: each multiplies its error
/// by about half the step below, three leave a hundred-thousandth.
inline constexpr int midpoint_iterations = 3;
/// Turn in one step of rotation [rad].
inline constexpr double rotation_step = 0.05;
/// Most such steps in a sub-step of a body in contact, three radians, and in a tick of one in free
/// flight, a hundred, where they cost less [-].
inline constexpr int most_rotation_steps = 64, most_rotation_steps_in_flight = 2000;

// Sleeping.

/// Speed of rest without weight, of the body's radius a second [1/s]: as good as still.
inline constexpr double weightless_rest = 1e-4;
/// Speed of rest, of what a body gains in free flight while it must rest to sleep [-]: one that is
/// thrown up is slower than that for half of the time at most.
inline constexpr double slow_in_flight = 0.25;
/// Time over which velocities are averaged to tell rest from motion, of the time that a group must
/// rest before it sleeps [-]: four ticks of 1/60 s with the usual settings. Heaps tremble with
/// periods of a few ticks; what is set in motion is seen as long before it would sleep.
inline constexpr double averaged_of_sleep_time = 0.125;

// What moves far in a tick.

/// How deep a contact may close without being stopped, in inner radii [-]: the solver deals with
/// that in the next tick, and what slides or rolls fast is not held up by every bump.
inline constexpr double shallow_depth = 0.25;
/// Share of the thickness of a surface of triangles that may be passed in a tick or a part of one
/// [-]: up to half of it the nearest way out is the one back.
inline constexpr double passed_of_thickness = 0.5;
/// Thickness of convex shapes in ticks that are followed closely, of the inner radius [-]: half of
/// it is passed between two looks for contacts. A pulled column, and things of a millimetre that
/// fall in a room of a centimetre, overlap by a third of what they do with five times as much.
inline constexpr double close_of_radius = 0.1;
/// Thickness, of the size, below which a mesh has a sharp rim and a convex body no inside to be
/// pushed out of [-].
inline constexpr double thin_of_size = 0.02;
/// Least inner radius that counts, of the smaller body's radius, since meshes may have no inside at
/// all; and thickness below which a pair is thin unless both are meshes [-].
inline constexpr double thin_pair_of_radius = 0.05;
/// Turn in a tick, of half a turn, from which on the angular velocity says which way a body went,
/// as two poses do not [-].
inline constexpr double winding_of_half_turn = 0.9;
/// Precision of a time of contact as a distance [m]: a thousandth of the smaller body's radius, of
/// bodies above a decimetre a tenth of a millimetre, and no less than a nanometre.
inline constexpr double contact_of_radius = 1e-3, contact_radius = 0.1,
                        least_contact_distance = 1e-9;
/// Distance of a shape's axis from the body's centre, of its radius, that is rounding [-].
inline constexpr double axis_through_centre = 1e-9;
/// Difference to free flight, relative to the speed and 1 m/s, that is rounding [-].
inline constexpr double free_flight = 1e-9;
/// Most looks at a pair in a tick while it touches [-]: one that needs more is held where it was
/// seen last.
inline constexpr int most_looks = 64;
/// Depth, of the inner radius, by which an overlap may grow between bodies that touched at the
/// start [-]: they are in the solver's hands, and those that pass the middle would come out on the
/// other side.
inline constexpr double growing_overlap = 0.5;
/// Share of the allowed depth that a pair closes between two looks [-]: so it is seen once before
/// it is deeper.
inline constexpr double look_step = 0.5;

}  // namespace tumble::tolerances
