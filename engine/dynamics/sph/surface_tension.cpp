// The surface as a smooth step c of the fluid's share, whose energy is kappa / 2 times the integral
// of the squared gradient of c (van der Waals 1893; for SPH He et al., "Robust simulation of
// sparsely sampled thin features", 2014). Particles see the inner half of a step. A plane surface
// then costs the surface tension per area where kappa = 2 sigma / (integral of plane(d)^2, d > 0).
// Forces are minus the derivatives of the sum over the particles, so that momentum, angular
// momentum and energy are kept.
#include "engine/dynamics/sph/fluid_state.hpp"

#include <cmath>
#include <numbers>

namespace tumble {

void pull_surfaces(FluidState& s) {
  if (s.def->surface_tension == 0) return;
  const double kappa = 2 * s.def->surface_tension / s.kernel.interface_integral();
  VectorArrays n;
  n.assign(s.lists.places());
  s.each([&](size_t p) {
    // Without the walls' part, which s.gradient has twice.
    Vec3 g = s.gradient[p];
    for (const WallTouch& t : s.touches_of(p)) g += (s.def->adhesion - 1) * t.gradient;
    n.set(p, g);
  });
  // The gradient of a wall's share changes along the wall's normal, as if it were flat.
  const auto of_wall = [&](size_t p, const WallTouch& t) -> Vec3 {
    const double bend = 2 * std::numbers::pi * t.distance * s.kernel.value(std::abs(t.distance));
    return -kappa * s.def->adhesion * bend * n[p].dot(t.normal) * t.normal;
  };
  s.each([&](size_t p) {
    Vec3 f = -kappa * sum_curvatures(s.kernel, s.points(), s.volume.data(), n.view(), s.list(p));
    for (const WallTouch& t : s.touches_of(p)) f += of_wall(p, t);
    s.acceleration.set(p, f / s.def->density);
  });
  std::vector<Wrench> impulses = s.sum_wrenches([&](size_t p, std::span<Wrench> to) {
    for (const WallTouch& t : s.touches_of(p))
      s.add_force(to, t.body, s.x(p), -s.h * s.volume[p] * of_wall(p, t));
  });
  s.report.tension_work += s.accelerate(s.def->density);
  s.push_bodies(impulses);
}

}  // namespace tumble
