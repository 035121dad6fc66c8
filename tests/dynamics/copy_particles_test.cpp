// Copies of particle systems, on any threads. Reference: what they save.
#include "engine/dynamics/particles/copy_particles.hpp"

#include "engine/core/random.hpp"
#include "engine/dynamics/particles/fluid_def.hpp"

#include <doctest/doctest.h>

using namespace tumble;

namespace {

ParticleSystem filled(ParticleSystemDef def, size_t count) {
  ParticleSystem p = make_particle_system(def);
  Random random(count);
  const auto vector = [&random] {
    return Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  };
  for (size_t n = 0; n < count; ++n) {
    ParticleDef one;
    one.x = vector();
    one.v = vector();
    one.spin = vector();
    one.mass = random.uniform(1, 2);
    one.radius = random.uniform(0.01, 0.02);
    one.life = random.uniform(1, 9);
    p.add(one, {}, random.uniform(0, 1));
    p.force.back() = vector();
  }
  return p;
}

ParticleSystem grains(size_t count) {
  ParticleSystemDef def;
  def.name = "sand with a name that is longer than what strings keep in themselves";
  def.friction = 0.3;
  def.grains = GrainDef{0.1, 0.2, 8};
  return filled(def, count);
}

ParticleSystem water(size_t count) {
  ParticleSystemDef def;
  def.name = "water";
  def.collide = false;
  def.fluid = std::make_shared<FluidDef>();
  return filled(def, count);
}

Bytes saved(const ParticleSystem& p) {
  ByteWriter out;
  p.save(out);
  return out.take();
}

}  // namespace

TEST_CASE("a copy of particles saves what they save, whatever it was before") {
  for (const int threads : {1, 3}) {
    Crew crew(threads);
    ParticleSystem copy;
    for (ParticleSystem from : {grains(1000), water(700), grains(3), grains(2000)}) {
      const Bytes before = saved(from);
      from.reserve(2500);
      copy_particles(from, copy, &crew);
      CHECK(saved(from) == before);
      CHECK(saved(copy) == before);
      CHECK(copy.x.capacity() >= 2500);
      CHECK(copy.density.empty() == from.density.empty());
      CHECK(copy.rest.size() == from.rest.size());
    }
  }
}
