#pragma once
#include "engine/core/result.hpp"
#include "engine/math/types.hpp"

#include <cstdint>
#include <string_view>
#include <vector>

namespace tumble {

/// Method for the pressure.
enum class FluidSolverKind : uint8_t {
  /// Divergence-free SPH (Bender and Koschier, "Divergence-free SPH for incompressible and viscous
  /// fluids", 2017): pressures by which density neither exceeds the rest density nor is about to.
  dfsph,
  /// Weakly compressible SPH (Becker and Teschner, "Weakly compressible SPH for free surface
  /// flows", 2007): pressure is a stiff function of density.
  wcsph,
};
enum class FluidKernelKind : uint8_t { cubic_spline, wendland };

/// Properties of a particle system that is a fluid. Masses of particles are those of the system;
/// each particle represents the volume mass / density.
struct FluidDef {
  FluidSolverKind solver = FluidSolverKind::dfsph;
  FluidKernelKind kernel = FluidKernelKind::cubic_spline;
  double density = 1000;  ///< at rest [kg/m3]
  /// Support radius of the kernel [spacings: cube roots of particle volumes]
  double smoothing = 2;
  double viscosity = 0.001;    ///< dynamic, solved implicitly [Pa s]
  double xsph = 0.05;          ///< share of the difference to the mean velocity about it that a
                               ///< particle loses in a sub-step (Schechter and Bridson 2012) [-]
  double surface_tension = 0;  ///< [N/m]
  double adhesion =
      /// Adhesion to walls over cohesion of the fluid: (1 + cosine of the contact angle) / 2 [-]
      0;
  double wall_friction = 0;  ///< viscosity at walls, as a share of `viscosity`; 1 is no slip [-]
  // dfsph
  double density_error = 0.0005;  ///< mean relative density error at which iterations stop [-]
  int most_iterations = 100;      ///< of each of the two solves of a sub-step
  // wcsph
  double sound_speed = 0;  ///< [m/s]; 0: ten times the speed of the fastest particle or wave
  double cfl = 0.4;        ///< greatest distance that a particle moves in a sub-step [spacings]
};

Status validate(const FluidDef& def);

/// Names as in scene files: "dfsph", "wcsph"; "cubic_spline", "wendland".
struct FluidSolverName {
  std::string_view name;
  FluidSolverKind kind;
};
struct FluidKernelName {
  std::string_view name;
  FluidKernelKind kind;
};
const std::vector<FluidSolverName>& all_fluid_solvers();
const std::vector<FluidKernelName>& all_fluid_kernels();

}  // namespace tumble
