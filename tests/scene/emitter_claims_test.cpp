// What scenes with emitters claim. References: counts by rate and life, and closed forms of free
// flight.
#include "engine/world/world.hpp"
#include "tests/scene/shipped_scene.hpp"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

const ParticleSystem& system_named(const BuiltScene& s, const std::string& name) {
  const auto it = s.particles.find(name);
  REQUIRE(it != s.particles.end());
  return *s.world->particles(it->second);
}

const Emitter& emitter_named(const BuiltScene& s, const std::string& name) {
  const auto it = s.emitters.find(name);
  REQUIRE(it != s.emitters.end());
  return *s.world->emitter(it->second);
}

}  // namespace

TEST_CASE("fountain: 2,400 drops a second rise as high as their speed says, and most fall back") {
  BuiltScene s = shipped("fountain");
  run(s, 5);
  CHECK(emitter_named(s, "jet").made == 5 * 2400);
  const ParticleSystem& water = system_named(s, "water");
  double top = 0;
  size_t within = 0, below = 0;
  for (const Vec3& x : water.x) {
    top = std::max(top, x.y());
    within += std::hypot(x.x(), x.z()) < 2.5;
    below += x.y() < 0;
  }
  // Of thousands some have the greatest speed there is, four deviations above the mean.
  const double most = 5.7 + 4 * 0.22, mean = 5.7;
  CHECK(top < 1.46 + most * most / (2 * 9.81));
  CHECK(top > 1.46 + mean * mean / (2 * 9.81));
  CHECK(double(within) > 0.97 * double(water.size()));
  CHECK(below == 0);
  // As many as are born within the mean life, less what the gutter takes.
  CHECK(double(water.size()) < 1.03 * (2400 * 2.6 + 900 * 1.1));
  CHECK(double(water.size()) > 0.8 * (2400 * 2.6 + 900 * 1.1));
}

TEST_CASE("fireworks: each rocket that died has burst into its number of sparks") {
  BuiltScene s = shipped("fireworks");
  run(s, 6);
  const auto bursts_of = [&](const char* rocket, const char* burst, uint64_t sparks) {
    const Emitter& rockets = emitter_named(s, rocket);
    const uint64_t dead = rockets.made - rockets.alive;
    CHECK(dead >= 3);
    CHECK(emitter_named(s, burst).made == sparks * dead);
  };
  bursts_of("red_rocket", "red_burst", 260);
  bursts_of("gold_rocket", "gold_burst", 170);
  bursts_of("blue_rocket", "blue_burst", 240);
  // Two flashes for each blue spark that has gone out, less those in the air.
  const Emitter& blue = emitter_named(s, "blue_burst");
  CHECK(emitter_named(s, "crackle").made == 2 * (blue.made - blue.alive));
  const ParticleSystem& sparks = system_named(s, "sparks");
  for (size_t i = 0; i < sparks.size(); ++i) CHECK(sparks.age[i] < sparks.life[i]);
}

TEST_CASE("volley: shots come ever faster, smoke all along, strike with dust and chips") {
  BuiltScene s = shipped("volley");
  run(s, 3);
  const Emitter& shots = emitter_named(s, "shot");
  // Two a second by a factor that rises from 0.6 by 0.1 a second: 4.5.
  CHECK(shots.made == 4);
  double flown = 0;
  for (int k = 1; k <= 4; ++k) {
    const double t = -6 + std::sqrt(36 + 10.0 * k);  // 2 (0.6 t + 0.05 t^2) = k
    flown += std::floor(45 * (3 - t));
  }
  CHECK(emitter_named(s, "puff").made == 4 * 14 + uint64_t(flown));
  // The first two are down: they fly for about 1.3 s.
  const uint64_t dust = emitter_named(s, "cloud").made;
  CHECK(dust >= 2 * 8);
  CHECK(dust % 8 == 0);
  CHECK(emitter_named(s, "flash").made == 3 * dust);
  CHECK(emitter_named(s, "chips").made == std::min<uint64_t>(120, dust / 4));  // no more at once
}

TEST_CASE("conveyor: nine bodies a second come, and as many go, and none falls beside the belt") {
  BuiltScene s = shipped("conveyor");
  run(s, 10);
  const auto moving = [&s] {
    size_t count = 0;
    for (const char* name : {"stones", "crates", "balls"})
      count += emitter_named(s, name).bodies.size();
    return count;
  };
  const size_t before = moving();
  run(s, 10);
  CHECK(emitter_named(s, "stones").made == 80);
  CHECK(emitter_named(s, "crates").made == 59);  // 3 (20 - 0.1)
  CHECK(emitter_named(s, "balls").made == 39);   // 2 (20 - 0.2)
  // On the way are those of some seven seconds, and no more and more.
  CHECK(before > 40);
  CHECK(before < 80);
  CHECK(std::fabs(double(moving()) - double(before)) < 20);
  const auto frame = s.world->frame();
  for (size_t slot = 0; slot < frame->body_slots(); ++slot) {
    if (frame->body(slot).id.is_null() || frame->info(slot).type != BodyType::dynamic) continue;
    const Vec3& x = frame->body(slot).pose.x;
    CHECK(std::fabs(x.z()) < 1);
    CHECK((x.y() > 0.9 || x.x() > 2.9));
  }
}

TEST_CASE("rain_feeder: parts come, pass the line and leave, and the hoppers are filled again") {
  BuiltScene s = shipped("rain_feeder");
  run(s, 25);
  for (const char* name : {"l_parts", "bars", "t_parts"}) {
    const Emitter& parts = emitter_named(s, name);
    INFO(name);
    CHECK(parts.made >= 25);
    CHECK(parts.made - parts.bodies.size() >= 3);  // left by the chute
    CHECK(parts.bodies.size() >= 5);
  }
  // Drops that have met something are gone: what is left is in the air.
  CHECK(system_named(s, "rain").size() < 2500 * 2.05);
}
