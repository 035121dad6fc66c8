// Surface tension as attraction between particles (Becker and Teschner 2007; Tartakovsky and
// Panchenko, "Pairwise force smoothed particle hydrodynamics model for multiphase flow", 2016): two
// of them have the energy -A V V' W. To part a fluid along a plane takes A times the sum of z
// plane(z) over the pairs of layers across it, z apart, for the two surfaces that it leaves; that
// is how A follows from the surface tension. Energy, momentum and angular momentum are kept. What
// the attraction adds to the pressure inside is the same everywhere, and the pressure solve bears
// it. Particles of two fluids attract each other by the geometric mean of their A (Girifalco and
// Good, "A theory for the estimation of surface and interfacial energies", 1957), so that their
// interface has the square of the difference of the roots of both tensions.
#include "engine/dynamics/sph/fluid_state.hpp"

#include <cmath>

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
  if (!s.any(&FluidDef::surface_tension)) return;
  const double across = layers_across(s.kernel, s.spacing);
  // Of A.
  const auto root = [&](size_t p) { return std::sqrt(2 * s.def(p).surface_tension / across); };
  s.each([&](size_t p) { s.terms.put(p, pressing(s, p, root(p))); });
  // A wall's gradient is that of a mirror image, which moves twice as much as a wall does.
  const auto of_wall = [&](size_t p) { return 0.5 * s.def(p).adhesion * root(p) * root(p); };
  s.each_with_pairs(FluidFactor::slope, s.terms, nullptr, [&](size_t p, const FluidVector& sum) {
    Vec3 walls = Vec3::Zero();
    for (const WallTouch& t : s.touches_of(p)) walls += t.gradient;
    const Vec3 pairs = pressed(s, p, sum);
    s.acceleration.set(p, (root(p) * pairs + of_wall(p) * walls) / s.density[p]);
  });
  std::vector<Wrench> impulses = s.sum_wrenches([&](size_t p, std::span<Wrench> to) {
    for (const WallTouch& t : s.touches_of(p))
      s.add_force(to, t.body, s.x(p), -s.h * s.volume[p] * of_wall(p) * t.gradient);
  });
  s.report.tension_work += s.accelerate();
  s.push_bodies(impulses);
}

}  // namespace tumble
