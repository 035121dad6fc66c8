#include "engine/dynamics/particles/fluid_def.hpp"

#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

Status out_of_range(std::string_view name, double value, std::string_view cure) {
  return Error{ErrorCode::invalid_argument, fmt::format("{} is {}", name, value), "fluid",
               std::string(cure)};
}

}  // namespace

Status validate(const FluidDef& def) {
  const auto positive = [](double v) { return v > 0 && std::isfinite(v); };
  const auto share = [](double v) { return v >= 0 && v <= 1; };
  const auto not_negative = [](double v) { return v >= 0 && std::isfinite(v); };
  if (!positive(def.density))
    return out_of_range("density", def.density, "give a positive number of kg/m3; water has 1000");
  if (!(def.smoothing >= 1.5 && def.smoothing <= 4))
    return out_of_range("smoothing", def.smoothing,
                        "give the reach of the kernel in spacings of particles, 1.5 to 4");
  if (!not_negative(def.viscosity))
    return out_of_range("viscosity", def.viscosity, "give 0 or more Pa s; water has 0.001");
  if (!share(def.xsph)) return out_of_range("xsph", def.xsph, "give a number from 0 to 1");
  if (!not_negative(def.surface_tension))
    return out_of_range("surface_tension", def.surface_tension,
                        "give 0 or more N/m; water in air has 0.072");
  if (!share(def.adhesion))
    return out_of_range("adhesion", def.adhesion, "give a number from 0 to 1");
  if (!share(def.wall_friction))
    return out_of_range("wall_friction", def.wall_friction, "give a number from 0 to 1");
  if (!(def.density_error > 0 && def.density_error <= 0.1))
    return out_of_range("density_error", def.density_error, "give a number above 0, at most 0.1");
  if (def.most_iterations < 1 || def.most_iterations > 100000)
    return out_of_range("most_iterations", def.most_iterations, "give 1 to 100000");
  if (!not_negative(def.sound_speed))
    return out_of_range("sound_speed", def.sound_speed, "give 0 (found by itself) or more m/s");
  if (!(def.cfl > 0 && def.cfl <= 1))
    return out_of_range("cfl", def.cfl, "give a number above 0, at most 1");
  return {};
}

const std::vector<FluidSolverName>& all_fluid_solvers() {
  static const std::vector<FluidSolverName> list{{"dfsph", FluidSolverKind::dfsph},
                                                 {"wcsph", FluidSolverKind::wcsph}};
  return list;
}

const std::vector<FluidKernelName>& all_fluid_kernels() {
  static const std::vector<FluidKernelName> list{{"cubic_spline", FluidKernelKind::cubic_spline},
                                                 {"wendland", FluidKernelKind::wendland}};
  return list;
}

}  // namespace tumble
