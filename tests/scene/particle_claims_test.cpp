// What scenes of particles claim. Reference: the cradle's closed form (what arrives leaves at the
// other end, the height of the fall gives its speed).
#include "engine/world/world.hpp"
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

TEST_CASE(
    "melting_crystal: the order of the lattice goes, half of the heat goes into it, energy stays") {
  BuiltScene s = shipped("melting_crystal");
  const ParticleSystem& atoms = system_named(s, "below");
  constexpr double spacing = 0.11;
  // A face-centred lattice has neighbours at 1 and sqrt(2) spacings and none between; in a liquid
  // some are on their way from one shell to the next.
  const auto between_shells = [&atoms] {
    size_t count = 0;
    for (const Vec3& a : atoms.x)
      for (const Vec3& b : atoms.x) {
        const double d = (a - b).norm() / spacing;
        count += d > 1.15 && d < 1.32;
      }
    return double(count) / double(atoms.size());
  };
  const auto& energies = s.world->frame()->stats.energies;
  const double kinetic = energies.kinetic, total = energies.total();
  CHECK(between_shells() == 0);
  const auto peak = [&s] {
    for (const SensorFrame& sensor : *s.world->frame()->sensors)
      for (const SensorValue& value : sensor_values(sensor))
        if (value.name == "peak") return value.value;
    return 0.0;
  };
  const double order = peak();
  run(s, 3);
  CHECK(peak() < 0.5 * order);
  CHECK(between_shells() > 1);
  const auto& now = s.world->frame()->stats.energies;
  CHECK(now.kinetic < 0.65 * kinetic);
  CHECK(now.kinetic > 0.3 * kinetic);
  CHECK(std::abs(now.total() - total) < 0.005 * kinetic);
}

TEST_CASE("galaxies: momentum and energy stay, and stars are torn far out of both discs") {
  BuiltScene s = shipped("galaxies");
  const ParticleSystem &cores = system_named(s, "cores"), &blue = system_named(s, "blue"),
                       &gold = system_named(s, "gold");
  const auto momentum = [&] {
    Vec3 sum = Vec3::Zero();
    for (const ParticleSystem* p : {&cores, &blue, &gold})
      for (size_t i = 0; i < p->size(); ++i) sum += p->mass[i] * p->v[i];
    return sum;
  };
  const Vec3 before = momentum();
  const double energy = s.world->frame()->stats.energies.total();
  const auto torn = [&] {
    size_t count = 0;
    for (const ParticleSystem* p : {&blue, &gold})
      for (const Vec3& x : p->x)
        count += std::min((x - cores.x[0]).norm(), (x - cores.x[1]).norm()) > 1.6;
    return count;
  };
  CHECK(torn() == 0);
  run(s, 4);
  CHECK(torn() > 50);
  CHECK((momentum() - before).norm() < 1e-10);
  CHECK(s.world->frame()->stats.energies.total() == doctest::Approx(energy).epsilon(0.01));
}
