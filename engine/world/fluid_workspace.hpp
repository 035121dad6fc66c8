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
  std::vector<FluidSolver> solvers;  ///< by slot of particle systems
  std::vector<FluidReport> reports;  ///< likewise
  std::vector<OnBody> on_bodies;     ///< ascending by slot; bodies that nothing moves too
  std::vector<uint8_t> pressed;      ///< by slot of bodies: by contacts, in the last tick
  std::vector<uint32_t> slots;       ///< of `bodies`
  std::vector<FluidBody> bodies;
  std::vector<FluidWall> walls;
  std::vector<Vec3> acceleration, x, v;  ///< of one fluid's particles; the last two before the tick
};

}  // namespace tumble
