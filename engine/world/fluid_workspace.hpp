#pragma once
#include "engine/dynamics/sph/fluid_solver.hpp"

#include <cstdint>
#include <vector>

namespace tumble {

/// Scratch memory of the stage that moves fluids, and its results in the last tick.
struct FluidWorkspace {
  /// Mean force of the fluids on a body over the tick, and mean torque about its centre of mass.
  struct OnBody {
    uint32_t slot = 0;
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  ///< [N], [N m]
  };
  /// Particles of the fluids that are solved together, in the order of their systems.
  struct Together {
    std::vector<const FluidDef*> defs;
    std::vector<size_t> first;  ///< index of the first particle, by system
    std::vector<Vec3> x, v, acceleration;
    std::vector<double> pressure, mass;
    std::vector<uint8_t> fluid;
    std::vector<Vec3> x_before, v_before;  ///< positions and velocities at the start of the tick
  };
  std::vector<FluidSolver> solvers;  ///< one per set of fluids that are solved together
  std::vector<OnBody> on_bodies;     ///< ascending by slot; fixed and kinematic bodies too
  /// By body slot: whether a contact pressed it in the last tick.
  std::vector<uint8_t> pressed;
  std::vector<uint32_t> slots;  ///< body slots of `bodies`
  std::vector<FluidBody> bodies;
  std::vector<FluidWall> walls;
  Together together;
};

}  // namespace tumble
