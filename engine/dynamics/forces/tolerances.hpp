#pragma once

/// The numbers of this room that no setting gives: unit, reason, and source where there is one.
namespace tumble::tolerances {

// -- nets of springs

/// Largest z (see SpringNet) that is told from a rigid rod [-]: what weighs as much as the ends of
/// the spring stretches it by g h^2/z, 3e-8 m at 60 Hz. Stiffer springs are taken as this stiff,
/// which bounds the condition of the matrix, and so the work.
inline constexpr double stiffest_spring = 1e5;
/// SpringNet::Report::residual that is asked for [-]. What is left acts as an error of the velocity
/// of this share of its change.
inline constexpr double net_residual = 1e-8;
/// Of conjugate gradients [-]; nets of a condition of 1e5 need some thousands.
inline constexpr int most_net_iterations = 10'000;
/// How much of the first residual of a net with meshes may be left, in the norm of the inverted
/// diagonal [-]: the velocities are off by about this share of their change.
inline constexpr double mesh_net_residual = 3e-3;
/// Rounds of solving in single precision [-]; each takes off more than half of the digits that it
/// has.
inline constexpr int most_mesh_net_rounds = 8;
/// Of conjugate gradients in a round [-].
inline constexpr int most_mesh_net_steps = 2000;
/// A straight rope has no moment about itself, and no inertia but rounding: relative to the
/// greatest principal moment [-].
inline constexpr double no_rope_inertia = 1e-12;
/// SpringNet::ease of nets with meshes: 1/(6 - sqrt(32)) - 1 [-].
inline constexpr double stiff_ease = 1.914213562373095;
/// Weights of a bend add up to 0 but for rounding, relative to the sum of their sizes [-].
inline constexpr double bend_rounding = 1e-12;

// -- weaves

/// Most nodes of one weave [-].
inline constexpr double most_weave_nodes = 1e6;
/// Cosine up to which two sides are at right angles [-].
inline constexpr double right_angle = 1e-6;
/// Radius of the particles of a sheet, in spacings [-]. Four of them leave a hole of a radius of
/// 0.31 spacings, through which none of them fits; neighbours do not touch at rest.
inline constexpr double radius_in_spacings = 0.4;
/// A chain is straight that is longer than its chord by no more than this share, and hangs straight
/// down where its span is no more than this share of its length [-].
inline constexpr double no_sag = 1e-9;

// -- flows and drag

/// Argument below which (1 - exp(-s)) / s is taken from its series up to s^2 [-]: the difference
/// would lose more than four digits, and what the series leaves out is below 1e-13.
inline constexpr double exponential_series = 1e-4;
/// Length of an axis below which it names no direction [m].
inline constexpr double no_axis = 1e-12;
/// Bounding radius from which on a body is taken for endless, as half-spaces are [m]: a flow has no
/// grip on it.
inline constexpr double endless_body = 1e9;
/// Distance from the axis of a vortex ring below which the limit there is taken, in radii of the
/// ring [-]: the difference loses all digits.
inline constexpr double near_ring_axis = 1e-4;
/// Difference of the two means of an elliptic integral below which they are one, relative [-]: the
/// next round squares it.
inline constexpr double equal_means = 1e-9;
/// Root mean square of curl_noise over space and lattices. With f the fade over [-1, 1] and A, B,
/// C, D the integrals of f^2, t^2 f^2, f'^2, t^2 f'^2 its square is 2 (A^2 D + 2 A B C), for
/// entries of the gradients uniform in [-1, 1].
inline constexpr double curl_rms = 1.220077940729918;
/// Speed of eddies of half the size, relative [-]: 2^(-1/3) (Kolmogorov).
inline constexpr double octave_speed = 0.79370052598409974;
/// Points of the lattice are whole numbers, which hold to 2^53; nothing is this far away
/// [spacings].
inline constexpr double farthest_lattice = 1e15;

}  // namespace tumble::tolerances
