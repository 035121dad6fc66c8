#include "engine/collision/particle_contacts/checks.hpp"
#include "engine/collision/particle_contacts/gather.hpp"
#include "engine/collision/particle_contacts/particle_contacts.hpp"
#include "engine/core/registry.hpp"
#include "engine/geometry/continuous_tests/sphere_sphere.hpp"

#include <algorithm>

namespace tumble {
namespace {

struct NoMemory {};

/// Bounds of a ball that moves from x to y, enlarged for rounding.
Aabb swept_ball(const Vec3& x, const Vec3& y, double radius) {
  Aabb b{x.cwiseMin(y), x.cwiseMax(y)};
  return b.inflated(radius + 1e-15 * (b.min.cwiseAbs().cwiseMax(b.max.cwiseAbs())).maxCoeff());
}

/// The contact of two balls at one time.
ParticlePairContact ball_contact(const Vec3& xa, double ra, const Vec3& xb, double rb) {
  ParticlePairContact c;
  const Vec3 way = xb - xa;
  const double distance = way.norm();
  if (distance > 0) c.normal = way / distance;
  c.gap = distance - (ra + rb);
  c.x = xa + (ra + 0.5 * c.gap) * c.normal;
  return c;
}

/// Whether two moving balls are certainly apart all the time, rounding included: a quick test that
/// rejects most pairs whose swept bounds overlap.
bool surely_apart(const MovingSphere& a, const MovingSphere& b) {
  const Vec3 x = b.centre.start - a.centre.start, end = b.centre.end - a.centre.end;
  const Vec3 way = end - x;
  const double length2 = way.squaredNorm();
  const double t = length2 > 0 ? std::clamp(-x.dot(way) / length2, 0.0, 1.0) : 0;
  const double scale =
      std::max({a.centre.start.cwiseAbs().maxCoeff(), a.centre.end.cwiseAbs().maxCoeff(), a.radius,
                b.radius, x.cwiseAbs().maxCoeff(), end.cwiseAbs().maxCoeff()});
  return (x + t * way).norm() > a.radius + b.radius + 1e-12 * scale;
}

}  // namespace

ParticleContactFinder::ParticleContactFinder()
    : grid_((*find_named(all_broad_phases(), "multi_level_grid", "broad phase"))->make()) {}

void ParticleContactFinder::use_threads(Crew* crew) {
  crew_ = crew;
}

void ParticleContactFinder::find_neighbours() {
  grid_->use_threads(crew_);
  grid_->find_pairs(proxies_, pairs_);
}

Status ParticleContactFinder::touching_pairs(const ParticleBalls& balls, double margin,
                                             std::vector<ParticlePairContact>& out) {
  if (Status s = check_balls(balls); !s) return s;
  if (Status s = check_length("margin", margin, true); !s) return s;
  proxies_.resize(balls.x.size());
  for (size_t i = 0; i < proxies_.size(); ++i)
    proxies_[i] = {swept_ball(balls.x[i], balls.x[i], balls.radius[i] + 0.5 * margin), true};
  find_neighbours();
  gather_found<NoMemory>(crew_, pairs_.size(), out, [&](size_t k, NoMemory&, auto& found) {
    const auto [a, b] = pairs_[k];
    ParticlePairContact c = ball_contact(balls.x[a], balls.radius[a], balls.x[b], balls.radius[b]);
    if (!(c.gap <= margin)) return;
    c.a = a, c.b = b;
    found.push_back(c);
  });
  return {};
}

Status ParticleContactFinder::meeting_pairs(const ParticlePaths& paths,
                                            std::vector<ParticlePairMeeting>& out) {
  if (Status s = check_paths(paths); !s) return s;
  const std::span<const Vec3> x = paths.start.x;
  const std::span<const double> radius = paths.start.radius;
  const auto end = [&](size_t i) -> Vec3 { return x[i] + paths.h * paths.v[i]; };
  proxies_.resize(x.size());
  for (size_t i = 0; i < proxies_.size(); ++i)
    proxies_[i] = {swept_ball(x[i], end(i), radius[i]), true};
  find_neighbours();
  gather_found<NoMemory>(crew_, pairs_.size(), out, [&](size_t k, NoMemory&, auto& found) {
    const auto [a, b] = pairs_[k];
    const MovingSphere one{{x[a], end(a)}, radius[a]}, other{{x[b], end(b)}, radius[b]};
    if (surely_apart(one, other)) return;
    const auto met = moving_spheres_contact(one, other);
    if (!met || !*met) return;  // finite input is never refused
    const double t = (*met)->t_lo;
    const ParticlePairContact c =
        ball_contact(one.centre.at(t), radius[a], other.centre.at(t), radius[b]);
    found.push_back({a, b, t * paths.h, c.x, c.normal});
  });
  return {};
}

}  // namespace tumble
