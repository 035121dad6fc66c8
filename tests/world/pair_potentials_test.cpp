// Pair potentials between particles of a World. References: Kepler's third law, the harmonic
// oscillator, conservation laws.
#include "engine/core/random.hpp"
#include "tests/support/test_world.hpp"

#include <cmath>
#include <thread>

#include <doctest/doctest.h>

using namespace tumble;
using test::TestWorld;

namespace {

WorldSettings free_settings(int hz, const char* stepper = "realtime") {
  WorldSettings s;
  s.tick.num = hz;
  s.gravity = Vec3::Zero();
  s.stepper = stepper;
  return s;
}

ParticleSystemDef system_of(std::initializer_list<std::pair<Vec3, Vec3>> states, double mass) {
  ParticleSystemDef def;
  def.collide = false;
  for (const auto& [x, v] : states) {
    ParticleDef p;
    p.x = x, p.v = v, p.mass = mass, p.radius = 0.01;
    def.particles.push_back(p);
  }
  return def;
}

/// A crystal of Lennard-Jones atoms, which is shaken.
ParticleSystemDef shaken_crystal(int n, double spacing, double speed, uint64_t seed) {
  ParticleSystemDef def;
  def.collide = false;
  Random r(seed);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        ParticleDef p;
        p.x = spacing * Vec3(i, j, k);
        p.v = speed * Vec3(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1));
        p.mass = 1, p.radius = 0.04;
        def.particles.push_back(p);
      }
  return def;
}

Vec3 momentum(const ParticleSystem& p) {
  Vec3 sum = Vec3::Zero();
  for (size_t i = 0; i < p.size(); ++i) sum += p.mass[i] * p.v[i];
  return sum;
}

}  // namespace

TEST_CASE("pair potentials: two masses go round each other in the time of Kepler's third law") {
  for (const char* stepper : {"realtime", "event"}) {
    TestWorld w(free_settings(400, stepper));
    // Masses of 1 kg, 1 m apart, on a circle: omega^2 = G (m1 + m2) / r^3.
    MutualGravityDef gravity;
    gravity.strength = 2 * M_PI * M_PI;  // a turn a second
    const double speed = 2 * M_PI * 0.5;
    const auto id =
        w->create_particles(
             system_of({{{-0.5, 0, 0}, {0, 0, speed}}, {{0.5, 0, 0}, {0, 0, -speed}}}, 1))
            .value();
    w.force(gravity);
    w.apply();
    w.run(1);
    CHECK((w->particles(id)->x[0] - Vec3(-0.5, 0, 0)).norm() <
          (w->settings().stepper == "event" ? 1e-6 : 1e-3));
    CHECK(momentum(*w->particles(id)).norm() < 1e-12);
  }
}

TEST_CASE("pair potentials: Morse's well is a spring of stiffness 2 D a^2 near its bottom") {
  TestWorld w(free_settings(1000));
  MorseDef morse;
  morse.depth = 2, morse.distance = 0.2, morse.steepness = 10, morse.end.cutoff = 1;
  const double amplitude = 1e-5;
  const auto id =
      w->create_particles(
           system_of({{{0, 0, 0}, {0, 0, 0}}, {{0.2 + amplitude, 0, 0}, {0, 0, 0}}}, 0.5))
          .value();
  w.force(morse);
  w.apply();
  // Reduced mass 0.25 kg, k = 400 N/m: half a period is pi sqrt(0.25 / 400) s.
  double least = 1, at = 0;
  for (int n = 1; n <= 110; ++n) {
    w.run(0.001);
    const double d = w->particles(id)->x[1][0] - w->particles(id)->x[0][0];
    if (d < least) least = d, at = n * 0.001;
  }
  CHECK(at == doctest::Approx(M_PI * std::sqrt(0.25 / 400)).epsilon(0.02));
  CHECK(0.2 - least == doctest::Approx(amplitude).epsilon(0.01));
}

TEST_CASE("pair potentials: they end nowhere unless it is said where") {
  const Vec3 apart(0.8, 0, 0);
  const auto energy = [&](const ForceDef& f) {
    TestWorld w(free_settings(1000));
    w->create_particles(system_of({{{0, 0, 0}, {0, 0, 0}}, {apart, {0, 0, 0}}}, 1)).value();
    w.force(f);
    w.apply();
    return w->frame()->stats.energies.fields;
  };
  LennardJonesDef lj;
  lj.epsilon = 2, lj.sigma = 0.6;
  const double s6 = std::pow(lj.sigma / apart.x(), 6);
  CHECK(energy(lj) == doctest::Approx(8 * (s6 * s6 - s6)).epsilon(1e-12));
  MorseDef morse;
  morse.depth = 2, morse.distance = 0.5, morse.steepness = 3;
  const double fall = std::exp(-3 * (apart.x() - morse.distance));
  CHECK(energy(morse) == doctest::Approx(2 * (fall * fall - 2 * fall)).epsilon(1e-12));
}

TEST_CASE("pair potentials: energy is kept, the books close, momentum stays") {
  for (const char* stepper : {"realtime", "event"}) {
    TestWorld w(free_settings(1500, stepper));
    LennardJonesDef lj;
    lj.epsilon = 1, lj.sigma = 0.1, lj.end = {0.25, Truncation::smoothed, 0.2};
    const auto id = w->create_particles(shaken_crystal(4, 0.112, 0.3, 7)).value();
    w.force(lj);
    w.apply();
    const double before = w->frame()->stats.energies.total();
    CHECK(before < -64);
    const Vec3 p = momentum(*w->particles(id));
    w.run(0.3);
    const double after = w->frame()->stats.energies.total();
    CHECK(std::abs(after - before) < 2e-3 * std::abs(before));
    CHECK((momentum(*w->particles(id)) - p).norm() < 1e-12);
    CHECK(std::abs(w->frame()->stats.energies.fields) > 64);
  }
}

TEST_CASE("pair potentials: snapshots and threads give the same bits") {
  const auto run = [](int threads, bool through_snapshot) {
    TestWorld w(free_settings(1500));
    w->set_threads(threads);
    LennardJonesDef lj;
    lj.end.cutoff = 0.25;
    ParticleSystemDef def = shaken_crystal(9, 0.112, 0.3, 7);
    def.box.size = Vec3::Constant(9 * 0.112);
    w->create_particles(def).value();
    w.force(lj);
    PairTableDef table;
    table.r = {0.05, 0.1, 0.2}, table.energy = {0.2, 0.1, 0};
    w.force(table);
    w.apply();
    w.run(0.01);
    if (through_snapshot) {
      const auto bytes = w->save();
      w.run(0.005);
      REQUIRE(w->load(bytes));
    }
    w.run(0.01);
    for (const Vec3& x : w->particles(w->frame()->particles[0]->id)->x)
      CHECK((def.box.wrapped(x) - x).norm() == 0);
    return w->state_hash();
  };
  const uint64_t expected = run(1, false);
  CHECK(run(1, true) == expected);
  CHECK(run(2, false) == expected);
  CHECK(run(4, false) == expected);
}

TEST_CASE(
    "pair potentials: a world that is loaded between two makings of lists goes on as it would") {
  ParticleSystemDef def = shaken_crystal(6, 0.112, 0.3, 7);
  def.box.size = Vec3::Constant(6 * 0.112);
  for (size_t i = 0; i < def.particles.size(); i += 17) def.particles[i].life = 0.004;
  TestWorld w(free_settings(1500));
  w->create_particles(def).value();
  w.force(LennardJonesDef{.between = {}, .epsilon = 1, .sigma = 0.1, .end = {.cutoff = 0.25}});
  w.apply();
  for (int n = 0; n < 12; ++n) {
    const auto bytes = w->save();
    w.run(1.0 / 1500);
    uint64_t loaded = 0;
    // A thread of its own, which has no lists.
    std::thread([&] {
      TestWorld other(free_settings(1500));
      REQUIRE(other->load(bytes));
      other.run(1.0 / 1500);
      loaded = other->state_hash();
    }).join();
    CHECK(loaded == w->state_hash());
  }
  CHECK(w->frame()->particles[0]->x.size() < def.particles.size());
}

TEST_CASE("pair potentials: what has no meaning is refused with the reason") {
  TestWorld w(free_settings(60));
  ParticleSystemDef def = system_of({{{0, 0, 0}, {0, 0, 0}}}, 1);
  def.box.size = Vec3(1, 1, 1);
  w->create_particles(def).value();
  w.apply();
  const auto message = [&w](const ForceDef& f) {
    const auto made = w->create_force(f);
    return made ? std::string() : made.error().text();
  };
  LennardJonesDef lj;
  lj.end.cutoff = 2;
  CHECK(message(lj).find("longer than the periodic box") != std::string::npos);
  lj.end = {0.2, Truncation::smoothed, 0.3};
  CHECK(message(lj).find("smooth_from must be between 0 and the cutoff") != std::string::npos);
  lj.end = {0.1};
  CHECK(message(lj).find("not beyond sigma") != std::string::npos);
  CHECK(message(MutualGravityDef{}).find("give a cutoff") != std::string::npos);
  PairTableDef table;
  table.r = {0.1, 0.1}, table.energy = {1, 0};
  CHECK(message(table).find("r must ascend") != std::string::npos);
  LennardJonesDef point;
  point.sigma = 0;
  CHECK(message(point).find("sigma must be a finite number > 0") != std::string::npos);
  // Two in one place: no number comes out, and the run says which particle.
  TestWorld same(free_settings(60));
  same->create_particles(system_of({{{0, 0, 0}, {0, 0, 0}}, {{0, 0, 0}, {0, 0, 0}}}, 1)).value();
  same.force(LennardJonesDef{});
  same.apply();
  const auto stepped = same->step();
  REQUIRE_FALSE(stepped);
  CHECK(stepped.error().text().find("particle 1 of") != std::string::npos);
}
