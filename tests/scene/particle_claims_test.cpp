// What scenes of particles claim. Reference: the cradle's closed form (what arrives leaves at the
// other end, the height of the fall gives its speed).
#include "tests/scene/shipped_scene.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

const ParticleSystem& system_named(const BuiltScene& s, const std::string& name) {
  const auto it = s.particles.find(name);
  REQUIRE(it != s.particles.end());
  return *s.world->particles(it->second);
}

}  // namespace

TEST_CASE("particle_cradle: the last particle alone takes the blow, and gives it back") {
  BuiltScene s = shipped("particle_cradle");
  const ParticleSystem& balls = system_named(s, "balls");
  const auto speed = [&](size_t i) { return balls.v[i].norm(); };
  run(s, 0.85);
  const double blow = std::sqrt(2 * 9.81 * 2.1 * (1 - std::sqrt(0.5)));
  CHECK(speed(4) == doctest::Approx(blow).epsilon(0.05));
  for (size_t i = 0; i < 4; ++i) CHECK(speed(i) < 0.01 * blow);
  run(s, 0.65);  // at the top
  CHECK(balls.x[4].y() == doctest::Approx(1.5151).epsilon(0.01));
  run(s, 0.9);  // and back
  CHECK(speed(0) == doctest::Approx(blow).epsilon(0.1));
  for (size_t i = 1; i < 5; ++i) CHECK(speed(i) < 0.02 * blow);
}
