#pragma once
#include <cstddef>
#include <cstdint>

/// Constants of this folder that are no settings: unit, reason, and source where there is one.
namespace tumble::tolerances {

// How an island is solved.

/// Contact points times sub-steps that a precise island may cost in a tick: that of 512 points with
/// all of their 16 sub-steps [-].
inline constexpr size_t precise_budget = 8192;
/// Joints times sweeps, likewise, and the greatest number of sweeps [-].
inline constexpr size_t joint_budget = 512, most_joint_sweeps = 8;
/// Sweeps over the joints of an ordinary island in each pass [-]: forwards and backwards, so that
/// neither end of a chain is favoured.
inline constexpr int ordinary_joint_sweeps = 2;
/// Islands with no more points than this are always precise: all their sub-steps cost less than
/// finding their contacts. Examples: four boxes in a row, a double pendulum [-].
inline constexpr size_t negligible_work = 16;
/// Share of its inner radius that a body may sink into another in sub-steps of the ordinary length
/// [-]. Cubes of a metre and balls of half a metre are below it with 240 sub-steps a second, and
/// form towers of ten; bodies ten times smaller are not. Found with the accuracy cases A1 and A10.
inline constexpr double allowed_sink = 1e-3;
/// Greatest ratio of masses at a joint of an ordinary island [-]: a torso and its forearm have ten.
inline constexpr double borne_mass_ratio = 30;
/// A body with more contacts than this may leave some without a colour (one colour less than twice
/// the contacts of a body always suffice, see Colouring) [-].
inline constexpr uint16_t coloured_contacts = 16;
/// Squared ratio of an anchor's distance to the radius of gyration from which on the rows of a
/// joint are linearly dependent in single precision [-]: three of its seven digits are left.
inline constexpr double single_precision_arm = 1e4;

// Contacts and joints.

/// Rotation of a body in a tick from which on lever arms follow it [rad]: otherwise an arm would be
/// off by a fifth of its length at the end.
inline constexpr double arms_follow_turn = 0.2;
/// Distance of an anchor from the centre of rounding, relative to its radius, that is rounding
/// error [-].
inline constexpr double on_round_surface = 1e-9;
/// Greatest frequency of contacts and of joints, relative to the rate of sub-steps [-]. Joints and
/// hard contacts have a quarter, the bound of Box2D 3.0 (Catto 2024), above which they oscillate.
inline constexpr double contact_frequency_share = 0.125;
inline constexpr double joint_frequency_share = 0.25;
/// Damping ratio of joints [-]: as in Box2D 3.0 (Catto 2024). With this and the frequency, a
/// sub-step removes 28 % of an error; with half of it a swinging chain of twenty links in an
/// ordinary island gained 2 J.
inline constexpr double joint_damping_ratio = 2;
/// Frequency of hard contacts (is_hard) in multiples of that of others [-]: as in Box2D 3.0 against
/// immovable bodies (Catto 2024).
inline constexpr double hard_contact_frequency = 2;
/// Pivot of a joint's effective mass, relative to its diagonal entry, below which the row depends
/// on those before it [-]: ten thousand times the rounding error in double precision, sixteen times
/// in single.
inline constexpr double dependent_row = 1e-12;
inline constexpr float dependent_row_single = 1e-6f;
/// Rotation of a body in a sub-step up to which joints follow it [rad]. Beyond it the previous
/// impulses, which were in balance, act in wrong directions: a joint whose previous impulse alone
/// would turn the body as far again starts without a warm start. Otherwise joints between heavy
/// bodies would accelerate a light one without bound. Second-order terms of the joint's lines no
/// longer predict the end of such a sub-step either, and are limited to this rotation.
inline constexpr double max_turn_per_substep = 0.3;
/// An open joint is closed no faster than this along each of its rows [m/s], [rad/s]: one that was
/// assembled with its parts apart is corrected over many ticks. Joints that are held have errors of
/// millimetres, which are corrected at a hundredth of this speed.
inline constexpr double max_joint_correction = 10;
/// Sweeps over the coordinates of one joint each time that it is solved [-]: they are nearly
/// orthogonal, so that three sweeps leave less than a hundredth.
inline constexpr int drive_sweeps = 3;
/// A coordinate that reaches its limit more slowly than this does not bounce, and a contact that
/// closes more slowly is no hit on a mechanism [m/s], [rad/s]: a hundredth of what contacts need to
/// bounce, as only the joint itself is involved. Twice the speed that is gained in a sub-step is
/// added to it, so that series of bounces end.
inline constexpr double limit_rest_speed = 0.01;
/// Accuracy of bounces, relative to their speed [-]: a thousandth, as for the other rows of a
/// precise island. Each round of bounces and joints removes an eighth to a half of the error.
inline constexpr double bounce_error = 1e-3;
/// Most rounds of bounces and joints at the end of a tick in which something bounced [-]: 2^-32 of
/// the error is left if each round halves it.
inline constexpr int most_bounce_turns = 32;
/// Most joints of an island in which hits are solved as impacts of the whole mechanism [-]: in a
/// tracked vehicle of 60 links some contact is hit in nearly every sub-step.
inline constexpr size_t most_joints_of_hit = 8;
/// Most points that press or close in such an impact [-]: sixty unknowns, besides the few of
/// limits, motors and friction, up to which dense methods solve it in tens of microseconds. Of more
/// points those that are hit take part first, then those of bodies that are hit.
inline constexpr size_t most_points_of_hit = 20;
/// Strength of a damper over half a sub-step below which its implicit share is given by the first
/// term of its series [-]: the next term is a ten thousandth of it.
inline constexpr double weak_damper = 1e-4;

// Springs.

/// Share of an overlap that contacts in islands with springs correct in a sub-step [-]: the usual
/// one of Baumgarte's stabilisation (Catto 2005), which does not oscillate.
inline constexpr double rigid_share = 0.2;
/// Greatest sub-step of islands with springs [s]: backward Euler then damps oscillations above
/// about 40 Hz.
inline constexpr double spring_substep = 1.0 / 240;
/// How far the ends of springs and touching bodies may move past each other in a sub-step, as a
/// share of the shortest spring's length [-]: the error before a contact stops one.
inline constexpr double passed_in_substep = 0.125;
/// Frequency of a single spring with its ends, times the sub-step [rad]: up to here a few tens of
/// sweeps solve a lump of springs.
inline constexpr double stiff_in_substep = 10;
/// Greatest number of sub-steps that both conditions may give [-].
inline constexpr double most_spring_substeps = 64;
/// Springs and contacts are solved in turn until a sweep changes the impulses of springs by less
/// than this share of the greatest such change [-]. Lumps of 64 particles on 600 springs of 20 to
/// 2e4 N/m that hit the ground or a ball then gain less than a hundredth of their energy.
inline constexpr double spring_error = 0.01;
/// Greatest and least number of sweeps over springs in a sub-step, and the product of springs and
/// sweeps that limits it in between [-]: 5 ms; 8 sweeps for a cloth of 2,000 nodes.
inline constexpr size_t most_spring_sweeps = 100, least_spring_sweeps = 8, spring_budget = 120000;

// Motion.

/// Squared rotation in a sub-step from which on the gyroscopic term is included [rad2]: below a
/// milliradian it changes the direction of the angular velocity by no more than that.
inline constexpr double gyroscopic_turn2 = 1e-6;
/// Squared half angle up to which sine and cosine are computed by four terms of their series
/// [rad2]: the error is below 1e-16.
inline constexpr double series_half_turn2 = 0.0025;
/// Iterations for the angular velocity in the middle of a step of rotation [-]: each multiplies the
/// error by about half of rotation_step, so that three leave a hundred-thousandth.
inline constexpr int midpoint_iterations = 3;
/// Greatest rotation in one such step [rad].
inline constexpr double rotation_step = 0.05;
/// Most such steps in a sub-step of a body in contact (three radians), and in a tick of one in free
/// flight (a hundred), where they cost less [-].
inline constexpr int most_rotation_steps = 64, most_rotation_steps_in_flight = 2000;

// Sleeping.

/// Speed below which a body rests in weightlessness, in body radii per second [1/s]: practically
/// motionless.
inline constexpr double weightless_rest = 1e-4;
/// Greatest speed of rest, as a share of the speed that a body gains in free flight in the time for
/// which it must rest [-]: a body that is thrown up is slower than that for half of that time at
/// most.
inline constexpr double slow_in_flight = 0.25;
/// Time over which velocities are averaged to detect rest, as a share of the time for which an
/// island must rest before it sleeps [-]: four ticks of 1/60 s with the default settings. Heaps
/// tremble with periods of a few ticks; a body that is set in motion is noticed long before it
/// could sleep.
inline constexpr double averaged_of_sleep_time = 0.125;

// Bodies that move far in a tick.

/// Overlap that a contact on a body's path may reach without stopping it, in inner radii [-]: the
/// solver corrects it in the next tick, and bodies that slide or roll fast are not stopped by every
/// bump.
inline constexpr double shallow_depth = 0.25;
/// Share of the thickness of a triangulated surface that may be passed in a tick or a part of one
/// [-]: up to a half the shortest way out is the way back.
inline constexpr double passed_of_thickness = 0.5;
/// Thickness of convex shapes in ticks that are followed closely, as a share of the inner radius
/// [-]: half of it is passed between two searches for contacts. A pulled column, and bodies of a
/// millimetre that fall in a room of a centimetre, then overlap by a third of what they do with
/// five times this share.
inline constexpr double close_of_radius = 0.1;
/// Thickness, relative to the size, below which the rim of a mesh counts as sharp, and a convex
/// body has no inside from which it could be pushed out [-].
inline constexpr double thin_of_size = 0.02;
/// Least inner radius that counts, as a share of the smaller body's radius, since meshes may have
/// no inside; and thickness below which a pair is thin, unless both shapes are meshes [-].
inline constexpr double thin_pair_of_radius = 0.05;
/// Rotation in a tick, as a share of half a turn, from which on the angular velocity and not the
/// two poses determines the motion of a body [-].
inline constexpr double winding_of_half_turn = 0.9;
/// Accuracy of a time of contact, as a distance [m]: a thousandth of the smaller body's radius, at
/// most a tenth of a millimetre (for bodies above a decimetre), and at least a nanometre.
inline constexpr double contact_of_radius = 1e-3, contact_radius = 0.1,
                        least_contact_distance = 1e-9;
/// Distance of a shape's axis from the body's centre, relative to the radius, that is rounding
/// error [-].
inline constexpr double axis_through_centre = 1e-9;
/// Difference from free flight, relative to the speed plus 1 m/s, that is rounding error [-].
inline constexpr double free_flight = 1e-9;
/// Most tests of a touching pair in a tick [-]: a pair that needs more is stopped where it was last
/// tested.
inline constexpr int most_looks = 64;
/// Carriers for each of which all bodies are looked at [-]; for more the bodies are sorted first,
/// which costs as much as looking at them about ten times.
inline constexpr size_t few_carriers = 8;
/// Growth of overlap that is allowed to bodies that touched at the start, as a share of the inner
/// radius [-]: the solver handles these contacts, but a body that passes the middle would come out
/// on the other side.
inline constexpr double growing_overlap = 0.5;
/// Share of the allowed depth that a pair may close between two tests [-]: it is then tested at
/// least once before it is deeper.
inline constexpr double look_step = 0.5;

}  // namespace tumble::tolerances
