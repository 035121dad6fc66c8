#include "engine/world/particle_measures.hpp"

#include "engine/dynamics/particles/particle_system.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

ParticleMeasures measure_particles(const ParticleSystem& p) {
  ParticleMeasures out;
  out.count = p.size();
  if (p.size() == 0) return out;
  Aabb box;
  double mass = 0, squares = 0, fastest = 0, energy = 0;
  Vec3 moment = Vec3::Zero(), momentum = Vec3::Zero();
  for (size_t i = 0; i < p.size(); ++i) {
    const double square = p.v[i].squaredNorm();
    box.include(p.x[i]);
    mass += p.mass[i];
    moment += p.mass[i] * p.x[i];
    momentum += p.mass[i] * p.v[i];
    energy += 0.5 * p.mass[i] * square;
    squares += square;
    fastest = std::max(fastest, square);
  }
  const auto n = double(p.size());
  out.centre = moment / mass;
  out.low = box.min, out.high = box.max;
  out.speed = std::sqrt(squares / n);
  out.max_speed = std::sqrt(fastest);
  out.temperature = std::max(0.0, energy - 0.5 * momentum.squaredNorm() / mass) / (1.5 * n);
  for (const double pressure : p.pressure) out.pressure += pressure / n;
  return out;
}

}  // namespace tumble
