#pragma once
#include "engine/dynamics/sph/fluid_solver.hpp"

#include <cstdint>
#include <vector>

namespace tumble {

/// Memory of the stage that moves fluids, and what it found in the last tick.
struct FluidWorkspace {
  /// What fluids did to a body in the mean of the tick, about its centre of mass.
  struct OnBody {
    uint32_t slot = 0;
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  ///< [N], [N m]
  };
  /// Particles of fluids that are solved together, those of one system behind those of another.
  struct Together {
    std::vector<const FluidDef*> defs;
    std::vector<size_t> first;  ///< by system
    std::vector<Vec3> x, v, acceleration;
    std::vector<double> pressure, mass;
    std::vector<uint8_t> fluid;
    std::vector<Vec3> x_before, v_before;  ///< the tick
  };
  std::vector<FluidSolver> solvers;  ///< by set of fluids that are solved together
  std::vector<OnBody> on_bodies;     ///< ascending by slot; bodies that nothing moves too
  std::vector<uint8_t> pressed;      ///< by slot of bodies: by contacts, in the last tick
  std::vector<uint32_t> slots;       ///< of `bodies`
  std::vector<FluidBody> bodies;
  std::vector<FluidWall> walls;
  Together together;
};

}  // namespace tumble
