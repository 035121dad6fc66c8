#pragma once
#include <cstddef>

/// The numbers of this room that no setting gives: unit, reason, and source where there is one.
namespace tumble::tolerances {

/// Intervals of the tables of kernel integrals along an axis [-]: linear between them, integrals
/// are right to 5e-4.
inline constexpr int kernel_table = 64;

/// Particles are nowhere nearer to walls than this [spacings]: half of where the first layer of a
/// lattice is. An integral does not tell a particle that has gone into a wall and left a hole
/// behind from one that has not.
inline constexpr double wall_clearance = 0.25;

/// Of its depth, how much a particle that is nearer than that moves away from a wall in a sub-step
/// [-]: it gets little energy by it.
inline constexpr double wall_return = 0.1;

/// Sums of slopes are corrected as if eigenvalues of their moment were not below this [-]: they are
/// 1 inside a fluid and 1/2 at a plane surface; a particle that is nearly alone has none.
inline constexpr double least_moment = 0.3;
/// Sweeps of Jacobi's rotations of a moment [-]: they converge quadratically, from within a half.
inline constexpr int moment_sweeps = 4;

/// Of the acceleration of a particle by pressures, the part that a wall may give it by the distance
/// between the two [-]: that of the first layer of a lattice, which is borne by its wall alone.
inline constexpr double most_levered = 0.5;
/// Of the square of a lever over one more than it, times the mass of the layer: the most, over the
/// mass of the body [-]. At 4 pressures have no longer a solution for sure.
inline constexpr double lever_mass = 1;

/// How much farther lists of neighbours look than kernels reach [reaches], so that they last for
/// some sub-steps.
inline constexpr double list_skin = 0.1;

/// Groups of particles whose sums are found before they are made use of [-]: these then are still
/// in the nearest cache.
inline constexpr size_t batch_groups = 16;

/// Steps of the pressure solve, times the largest eigenvalue over the diagonal [-]: alone they are
/// stable below 2, and there are stiffer waves than the stiffest one of a lattice.
inline constexpr double gradient_step = 1.2;
/// The square of the sine of the angle between two changes of steps, below which they count as one
/// [-]: what is left of their sums in single precision is then rounding.
inline constexpr double least_angle = 1e-6;
/// Lengths of waves among which the stiffest one of a lattice is sought [-]: its eigenvalue is flat
/// there.
inline constexpr int waves_of_lattice = 64;

/// What velocities may add to the error of density in a sub-step, over the error that is allowed
/// [-]. They err smoothly, over the whole depth, and begin with the pressures of the last sub-step;
/// what they leave the shift has to find from nothing, which takes it several times as long.
inline constexpr double rate_share = 0.1;

/// Ratio of the residual to the source where viscous iterations end [-]: viscosity is known to
/// fewer digits.
inline constexpr double viscous_residual = 1e-6;
/// More viscous iterations are not made [-]: conjugate gradients halve the residual in every few.
inline constexpr int most_viscous_iterations = 200;
/// A tick that needs more sub-steps than this fails [-]: then speeds are a thousand times what a
/// tick can follow, and something has gone wrong before.
inline constexpr int most_sub_steps = 2000;

/// Of the period of the shortest capillary wave [-] (Brackbill et al. 1992).
inline constexpr double capillary_share = 0.4;

/// Exponent of the equation of state of water (Cole 1948) [-].
inline constexpr int tait_exponent = 7;
/// How much faster sound is than the fluid, for densities within a hundredth [-] (Monaghan 1994).
inline constexpr double sound_over_flow = 10;

}  // namespace tumble::tolerances
