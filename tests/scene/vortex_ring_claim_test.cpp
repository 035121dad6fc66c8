// What the scene with smoke rings claims. Reference: Kelvin's speed of a vortex ring, whose decay
// slows it down, and how fast fluid turns about its core.
#include "engine/world/world.hpp"
#include "tests/scene/shipped_scene.hpp"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

/// Where the ring of the first burst is after so many seconds of its life [m].
double ring_at(double seconds) {
  const double radius = 0.34, core = 0.16, circulation = 2, decay = 0.05;
  const double speed = circulation / (4 * M_PI * radius) * (std::log(8 * radius / core) - 0.25);
  return -2.0 + speed * (1 - std::exp(-decay * seconds)) / decay;
}

}  // namespace

TEST_CASE(
    "vortex_ring: smoke rings fly with Kelvin's speed, hold their smoke, and reach the cups") {
  BuiltScene s = shipped("vortex_ring");
  const ParticleSystem& smoke = *s.world->particles(s.particles.find("smoke")->second);
  const EmitterId lip = s.emitters.find("lip")->second;
  for (const double time : {0.8, 1.6}) {
    run(s, 0.8);
    size_t near = 0, all = 0;
    std::vector<double> along;
    for (size_t i = 0; i < smoke.size(); ++i) {
      if (smoke.emitter[i] != lip || smoke.age[i] < time - 0.1) continue;
      ++all;
      along.push_back(smoke.x[i].x());
      const double out = std::hypot(smoke.x[i].y() - 1.1, smoke.x[i].z());
      near += std::hypot(out - 0.34, smoke.x[i].x() - ring_at(time - 0.05)) < 0.3;
    }
    REQUIRE(all > 450);
    std::nth_element(along.begin(), along.begin() + std::ptrdiff_t(all / 2), along.end());
    CHECK(along[all / 2] == doctest::Approx(ring_at(time - 0.05)).epsilon(0.05));
    CHECK(double(near) > 0.7 * double(all));
  }
  const double top = place(s, "cup[9]").y();
  run(s, 4.4);
  CHECK(place(s, "cup[9]").y() < top - 0.2);
}
