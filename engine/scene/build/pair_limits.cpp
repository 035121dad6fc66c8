#include "engine/scene/build/pair_limits.hpp"

#include "engine/world/world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Curvature of a potential at its minimum, i.e. the stiffness of the equivalent spring of a pair
/// [N/m].
double well_stiffness(const ForceDef& def) {
  // (12 * 13 * 4 - 6 * 7 * 4 * 2) / 2^(7/3), at r = 2^(1/6) sigma.
  constexpr double lennard_jones = 57.146;
  if (const auto* lj = std::get_if<LennardJonesDef>(&def))
    return lennard_jones * lj->epsilon / (lj->sigma * lj->sigma);
  if (const auto* morse = std::get_if<MorseDef>(&def))
    return 2 * morse->depth * morse->steepness * morse->steepness;
  return 0;
}

double least_mass(const World& world, const std::vector<ParticleSystemId>& between,
                  const BuiltScene& built) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [name, id] : built.particles) {
    if (!between.empty() && std::ranges::find(between, id) == between.end()) continue;
    if (const ParticleSystem* system = world.particles(id))
      for (const double m : system->mass) least = std::min(least, m);
  }
  return least;
}

}  // namespace

std::vector<std::string> pair_limit_warnings(const BuiltScene& built) {
  std::vector<std::string> out;
  const WorldSettings& settings = built.world->settings();
  const double hz = double(settings.tick.num) / double(settings.tick.den);
  for (const auto& [name, id] : built.forces) {
    const ForceDef* force = built.world->force(id);
    const auto* between = force ? paired_systems(*force) : nullptr;
    const double stiffness = between ? well_stiffness(*force) : 0;
    if (!(stiffness > 0)) continue;
    // The highest frequency of a face-centred cubic crystal with springs between nearest
    // neighbours: omega^2 = 8 k / m (Ashcroft and Mermin, Solid State Physics, ch. 22). The
    // leapfrog scheme is unstable from omega h = 2; half of it leaves a margin for collisions.
    const double omega = std::sqrt(8 * stiffness / least_mass(*built.world, *between, built));
    if (!(omega / hz > 1)) continue;
    out.push_back(fmt::format(
        "forces.{}: particles in its well oscillate with up to {:.3g} rad/s, too fast for {:.6g} "
        "ticks a second: the motion may burst (\"tick_hz\": {:.0f}, a shallower well, or heavier "
        "particles)",
        name, omega, hz, std::ceil(omega / 10) * 10));
  }
  return out;
}

}  // namespace tumble
