#pragma once
#include "engine/dynamics/particles/fluid_def.hpp"
#include "engine/scene/description/values.hpp"

namespace tumble {

template <>
struct EnumNames<FluidSolverKind> {
  static constexpr std::array<std::pair<std::string_view, FluidSolverKind>, 2> values = {
      {{"dfsph", FluidSolverKind::dfsph}, {"wcsph", FluidSolverKind::wcsph}}};
};
template <>
struct EnumNames<FluidKernelKind> {
  static constexpr std::array<std::pair<std::string_view, FluidKernelKind>, 2> values = {
      {{"cubic_spline", FluidKernelKind::cubic_spline}, {"wendland", FluidKernelKind::wendland}}};
};

/// Properties of the particles of a system as a fluid.
struct FluidDescription {
  FluidDef def;

  static constexpr std::string_view schema_name = "fluid";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& self) {
    auto& d = self.def;
    v.field(d.solver,
            {.name = "solver",
             .doc = "dfsph: divergence-free, incompressible; wcsph: weakly compressible"});
    v.field(d.kernel, {.name = "kernel", .doc = "smoothing kernel"});
    v.field(d.density, {.name = "density",
                        .unit = "kg/m3",
                        .min = 0,
                        .max = 1e6,
                        .exclusive_min = true,
                        .doc = "at rest; particles of lattices get their mass from it"});
    v.field(d.smoothing, {.name = "smoothing",
                          .min = 1.5,
                          .max = 4,
                          .doc = "reach of the kernel in spacings of particles"});
    v.field(d.viscosity,
            {.name = "viscosity", .unit = "Pa s", .min = 0, .max = 1e9, .doc = "dynamic"});
    v.field(d.xsph, {.name = "xsph",
                     .min = 0,
                     .max = 1,
                     .doc = "share of the difference to the mean velocity about it that a "
                            "particle loses in a sub-step"});
    v.field(d.surface_tension,
            {.name = "surface_tension", .unit = "N/m", .min = 0, .max = 1e6, .doc = "of it"});
    v.field(d.adhesion,
            {.name = "adhesion", .min = 0, .max = 1, .doc = "of surface tension, towards walls"});
    v.field(d.wall_friction, {.name = "wall_friction",
                              .min = 0,
                              .max = 1,
                              .doc = "share of viscosity that walls have; 1 is no slip"});
    v.field(d.density_error, {.name = "density_error",
                              .min = 0,
                              .max = 0.1,
                              .exclusive_min = true,
                              .doc = "of dfsph: mean excess at which iterations stop"});
    v.field(d.most_iterations, {.name = "most_iterations",
                                .min = 1,
                                .max = 100000,
                                .doc = "of dfsph: in each of the two solves of a sub-step"});
    v.field(d.sound_speed,
            {.name = "sound_speed",
             .unit = "m/s",
             .min = 0,
             .max = 1e5,
             .doc = "of wcsph; 0: ten times the speed of the fastest particle or wave"});
    v.field(d.cfl, {.name = "cfl",
                    .min = 0,
                    .max = 1,
                    .exclusive_min = true,
                    .doc = "most spacings that a particle goes in a sub-step"});
  }
};

}  // namespace tumble
