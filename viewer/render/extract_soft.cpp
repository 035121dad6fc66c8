#include "viewer/render/extract_soft.hpp"

#include "engine/math/det/det.hpp"
#include "viewer/render/foam.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// The ball that a particle is for the surface, over its radius, which is half a spacing: so large
/// that those of neighbours overlap without holes.
constexpr double ball_radius = 1.7;
/// Drops that fly alone are smaller; and the shares of the density at rest between which balls
/// grow.
constexpr double drop_radius = 0.6, least_share = 0.3, grown_share = 0.6;
/// Puffs thin out towards their rim: what is seen of them is as large as the particle [-].
constexpr double puff_radius = 1.5;
constexpr double radii_of_clarity = 20;
constexpr double most_turn = 0.35;  ///< speed at which a puff turns [rad/s]

double median_radius(const ParticleFrame& p) {
  std::vector<double> radii = p.radius;
  const auto middle = radii.begin() + std::ptrdiff_t(radii.size() / 2);
  std::nth_element(radii.begin(), middle, radii.end());
  return *middle;
}

/// The radius of a particle's ball over its own.
double ball_of_share(double share) {
  const double u = std::clamp((share - least_share) / (grown_share - least_share), 0.0, 1.0);
  return drop_radius + (ball_radius - drop_radius) * u * u * (3 - 2 * u);
}

/// A number in 0..1 that is a particle's own.
double own_number(uint64_t id) {
  uint64_t h = id * 0x9E3779B97F4A7C15u;
  h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9u;
  h = (h ^ (h >> 27)) * 0x94D049BB133111EBu;
  return double((h ^ (h >> 31)) >> 11) / 9007199254740992.0;
}

}  // namespace

void add_liquid(const ParticleFrame& p, std::span<const Vec3> x, RenderScene& out) {
  if (x.empty()) return;
  const double radius = median_radius(p);
  const std::vector<float> foam = foam_of({x, p.v, p.share, 2 * radius});
  FluidSurface fluid;
  fluid.colour = p.colour.front();
  const double clarity = p.look.clarity > 0 ? p.look.clarity : radii_of_clarity * radius;
  fluid.clarity = float(clarity);
  fluid.radius = float(ball_radius * radius);
  // A particle is the cube of its spacing, two radii.
  fluid.fill = float(8 / (4 * det::pi / 3 * ball_radius * ball_radius * ball_radius));
  fluid.particles.reserve(x.size());
  for (size_t i = 0; i < x.size(); ++i) {
    const double share = i < p.share.size() ? double(p.share[i]) : 1;
    const double r = p.radius[i] * ball_of_share(share);
    fluid.particles.push_back({x[i].cast<float>(), float(r), foam[i] * float(p.look.foam)});
  }
  out.fluids.push_back(std::move(fluid));
}

void add_smoke(const ParticleFrame& p, std::span<const Vec3> x, RenderScene& out) {
  out.smoke.reserve(out.smoke.size() + x.size());
  for (size_t i = 0; i < x.size(); ++i) {
    const double own = own_number(p.ids[i]);
    const double age = i < p.age.size() ? double(p.age[i]) : 0;
    SmokePuff puff;
    puff.centre = x[i].cast<float>();
    puff.radius = float(puff_radius * p.radius[i]);
    puff.colour = p.colour[i];
    puff.opacity = i < p.opacity.size() ? p.opacity[i] : float(p.look.opacity);
    puff.glow = float(p.glow);
    puff.turn = float(2 * det::pi * own + most_turn * (2 * own - 1) * age);
    puff.kind = uint32_t(own * 4096);
    out.smoke.push_back(puff);
  }
}

}  // namespace tumble
