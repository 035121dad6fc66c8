#include "engine/scene/build/fluid_start.hpp"

#include "engine/dynamics/particles/fluid_def.hpp"
#include "engine/dynamics/sph/fluid_solver.hpp"
#include "engine/math/det/det.hpp"
#include "engine/world/tolerances.hpp"
#include "engine/world/world.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Least initial distance from walls over the spacing [-]; the particles of a lattice start at half
/// a spacing.
constexpr double start_clearance = 0.25;

bool falls(const World& world, const ParticleSystemDef& def) {
  const VaryingVec3& gravity = world.settings().gravity;
  return (gravity.varies() || gravity.now().norm() > 0) && def.gravity_scale != 0;
}

bool ends(const ParticleSystemDef& def) {
  return std::ranges::all_of(def.particles,
                             [](const ParticleDef& p) { return std::isfinite(p.life); });
}

bool contained(const ParticleSystemDef& def, std::span<const FluidWall> walls) {
  Aabb fluid;
  for (const ParticleDef& p : def.particles) fluid.include(p.x);
  for (const FluidWall& w : walls) {
    const Aabb box = w.shape->bounds(w.pose);
    // Beside the fluid, in plan view, and not entirely above it.
    if (box.min.x() <= fluid.max.x() && box.max.x() >= fluid.min.x() &&
        box.min.z() <= fluid.max.z() && box.max.z() >= fluid.min.z() &&
        box.min.y() <= fluid.max.y())
      return true;
  }
  return false;
}

/// A fluid has one kernel, whose width is determined by the mean volume of its particles.
Status one_spacing(const ParticleSystemDef& def) {
  const auto [finest, coarsest] =
      std::ranges::minmax(def.particles, {}, [](const ParticleDef& p) { return p.mass; });
  const auto spacing = [&](const ParticleDef& p) {
    return det::pow(p.mass / def.fluid->density, 1.0 / 3);
  };
  const double fine = spacing(finest), coarse = spacing(coarsest);
  if (coarse <= tolerances::most_spacing_ratio * fine) return {};
  return Error{ErrorCode::invalid_argument,
               fmt::format("particles of this fluid have spacings from {:.4g} m to {:.4g} m, whose "
                           "ratio may be {} at most: the coarse ones would miss each other",
                           fine, coarse, tolerances::most_spacing_ratio),
               "particles." + def.name,
               "fill all of it with about the same \"spacing\", or \"mass\" if that is given"};
}

}  // namespace

Status fit_fluid(const World& world, const std::map<std::string, BodyId, std::less<>>& bodies,
                 ParticleSystemDef& def, bool may_fall, std::vector<std::string>& warnings) {
  if (def.particles.empty()) return {};
  if (Status one = one_spacing(def); !one) return one;
  std::vector<FluidWall> walls;
  for (const auto& [name, id] : bodies)
    if (const RigidBody* b = world.body(id))
      for (const BodyShape& s : b->shapes) walls.push_back({s.shape.get(), b->pose * s.pose, 0});
  const bool comes_back = def.box.any();
  if (falls(world, def) && !may_fall && !ends(def) && !comes_back && !contained(def, walls))
    return Error{
        ErrorCode::invalid_argument, "nothing contains this fluid: it would fall for ever",
        "particles." + def.name,
        "place bodies about or below it; what is to fall has a \"life\" [s], a sink below, "
        "a periodic box, or \"gravity_scale\": 0"};
  std::vector<Vec3> x;
  double mass = 0;
  for (const ParticleDef& p : def.particles) {
    x.push_back(p.x);
    mass += p.mass;
  }
  const double spacing = det::pow(mass / double(x.size()) / def.fluid->density, 1.0 / 3);
  const std::vector<uint8_t> inside = inside_walls(x, walls, start_clearance * spacing);
  std::vector<ParticleDef> kept;
  for (size_t i = 0; i < inside.size(); ++i)
    if (!inside[i]) kept.push_back(def.particles[i]);
  const size_t gone = def.particles.size() - kept.size();
  def.particles = std::move(kept);
  if (gone > 0)
    warnings.push_back(
        fmt::format("particles.{}: {} of {} particles would begin in bodies and were left out",
                    def.name, gone, inside.size()));
  return {};
}

}  // namespace tumble
