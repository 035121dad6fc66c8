// Surface tension as attraction between particles (Becker and Teschner 2007; Tartakovsky and
// Panchenko, "Pairwise force smoothed particle hydrodynamics model for multiphase flow", 2016): two
// of them have the energy -A V V' W. To part a fluid along a plane takes A times the sum of z
// plane(z) over the pairs of layers across it, z apart, for the two surfaces that it leaves; that
// is how A follows from the surface tension. Energy, momentum and angular momentum are kept. What
// the attraction adds to the pressure inside is the same everywhere, and the pressure solve bears
// it.
#include "engine/dynamics/sph/fluid_state.hpp"

namespace tumble {
namespace {

/// What a fluid's layers, one spacing apart, attract each other with across a plane, per A [m].
double layers_across(const SmoothingKernel& kernel, double spacing) {
  double sum = 0;
  for (double z = spacing; z < kernel.reach(); z += spacing) sum += spacing * z * kernel.plane(z);
  return sum;
}

}  // namespace

void pull_surfaces(FluidState& s) {
  if (s.def->surface_tension == 0) return;
  const double strength = 2 * s.def->surface_tension / layers_across(s.kernel, s.spacing);
  // A wall's gradient is that of a mirror image, which moves twice as much as a wall does.
  const double wall = 0.5 * s.def->adhesion;
  s.each([&](size_t p) {
    Vec3 g = s.gradient[p];
    for (const WallTouch& t : s.touches_of(p)) g += (wall - 1) * t.gradient;
    s.acceleration.set(p, strength / s.def->density * g);
  });
  std::vector<Wrench> impulses = s.sum_wrenches([&](size_t p, std::span<Wrench> to) {
    for (const WallTouch& t : s.touches_of(p))
      s.add_force(to, t.body, s.x(p), -s.h * s.volume[p] * strength * wall * t.gradient);
  });
  s.report.tension_work += s.accelerate(s.def->density);
  s.push_bodies(impulses);
}

}  // namespace tumble
