#include "viewer/render/extract_soft.hpp"

#include "engine/math/det/det.hpp"
#include "viewer/render/foam.hpp"
#include "viewer/render/liquid_shapes.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Radius of a particle's ball for the surface over the particle's radius (half a spacing), large
/// enough that the balls of neighbours overlap without holes [-].
constexpr double ball_radius = 1.7;
/// The same for isolated drops, which are smaller; and the range of densities over the rest density
/// in which the ball grows from one to the other [-].
constexpr double drop_radius = 0.6, least_share = 0.3, grown_share = 0.6;
/// Radius of a puff over that of its particle: puffs fade towards their rim, so the visible part is
/// as large as the particle [-].
constexpr double puff_radius = 1.5;
constexpr double radii_of_clarity = 20;
constexpr double most_turn = 0.35;  ///< greatest angular speed of a puff [rad/s]

double median_radius(const ParticleFrame& p) {
  std::vector<double> radii = p.radius;
  const auto middle = radii.begin() + std::ptrdiff_t(radii.size() / 2);
  std::nth_element(radii.begin(), middle, radii.end());
  return *middle;
}

/// How far a particle with this density belongs to the liquid, 0..1; 0 is a drop.
double wholeness(double share) {
  const double u = std::clamp((share - least_share) / (grown_share - least_share), 0.0, 1.0);
  return u * u * (3 - 2 * u);
}

std::array<float, 6> packed(const Mat3& m) {
  return {float(m(0, 0)), float(m(1, 1)), float(m(2, 2)),
          float(m(0, 1)), float(m(0, 2)), float(m(1, 2))};
}

/// A pseudo-random number in 0..1 that depends on the particle's id only.
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
  const LiquidNeighbours neighbours(x, 2 * radius);
  const std::vector<float> foam = foam_of(neighbours, p.v, p.share);
  std::vector<double> whole(x.size(), 1);
  for (size_t i = 0; i < p.share.size(); ++i) whole[i] = wholeness(double(p.share[i]));
  const std::vector<LiquidShape> shapes = liquid_shapes(neighbours, whole);
  FluidSurface fluid;
  fluid.colour = p.colour.front();
  const double clarity = p.look.clarity > 0 ? p.look.clarity : radii_of_clarity * radius;
  fluid.clarity = float(clarity);
  fluid.radius = float(ball_radius * radius);
  // A particle represents a cube whose edge is the spacing, two radii.
  fluid.fill = float(8 / (4 * det::pi / 3 * ball_radius * ball_radius * ball_radius));
  fluid.particles.reserve(x.size());
  for (size_t i = 0; i < x.size(); ++i) {
    const double r = p.radius[i] * (drop_radius + (ball_radius - drop_radius) * whole[i]);
    fluid.particles.push_back({shapes[i].centre.cast<float>(), float(r),
                               foam[i] * float(p.look.foam), packed(shapes[i].to_ball)});
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
