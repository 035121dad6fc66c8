#pragma once
#include "engine/core/crew.hpp"
#include "engine/dynamics/grains/grain_pairs.hpp"

#include <doctest/doctest.h>

namespace tumble::test {

/// A system of grains, without a world around it.
struct GrainCloud {
  static constexpr double h = 1.0 / 60;  ///< tick [s]
  HandlePool<ParticleSystemTag> ids;
  std::vector<ParticleSystem> systems;
  BodySet bodies;
  RealtimeSettings settings;
  Crew crew;
  GrainField grains;

  explicit GrainCloud(int threads) : crew(threads) {
    ParticleSystemDef d;
    d.name = "cloud";
    d.grains = GrainDef{};
    ids.allocate();
    systems.push_back(make_particle_system(d));
  }
  GrainTick tick() { return {systems, ids, bodies, {}, {0, -9.81, 0}, h, settings, &crew}; }
  /// Adds a grain of 10 g; its rest, to be set.
  GrainRest& add(const Vec3& x, const Vec3& v, double radius) {
    ParticleDef p;
    p.radius = radius;
    p.mass = 0.01;
    p.x = x;
    p.v = v;
    systems[0].add(p);
    return systems[0].rest.back();
  }
  void gather() { REQUIRE(grains.gather(tick()).ok()); }
};

}  // namespace tumble::test
