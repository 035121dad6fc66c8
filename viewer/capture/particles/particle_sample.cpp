#include "viewer/capture/particles/particle_sample.hpp"

namespace tumble {

ParticleSample sample_particles(const ParticleSystem& p) {
  return {p.x, p.v, p.radius, p.mass, p.age, p.colour, p.id};
}

ParticleSample sample_particles(const ParticleSystem& from, const ParticleSystem& to, double s) {
  ParticleSample out = sample_particles(to);
  size_t then = 0;  // index of the same particle in the tick before
  for (size_t i = 0; i < to.size(); ++i) {
    while (then < from.size() && from.id[then] < to.id[i]) ++then;
    if (then == from.size() || from.id[then] != to.id[i]) continue;
    const Vec3 way = to.x[i] - from.x[then];
    out.x[i] = to.box.any() ? to.box.wrapped(from.x[then] + s * to.box.shortest(way))
                            : Vec3(from.x[then] + s * way);
    out.v[i] = from.v[then] + s * (to.v[i] - from.v[then]);
    out.age[i] = from.age[then] + s * (to.age[i] - from.age[then]);
  }
  return out;
}

}  // namespace tumble
