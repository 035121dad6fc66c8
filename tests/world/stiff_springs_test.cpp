// Springs that no tick resolves, through the World, and the watch on energy. References: the energy
// there was, which nothing here adds to; the momentum there was; the place where a net hangs at
// rest; exit by an error where an explicit integrator is asked for more than it can do.
#include "engine/core/random.hpp"
#include "tests/support/test_world.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;
using test::TestWorld;

namespace {

WorldSettings without_gravity(int hz = 60) {
  WorldSettings s;
  s.tick.num = hz;
  s.gravity = Vec3::Zero();
  s.realtime.sleeping = false;
  return s;
}

SpringDef between(const Anchor& a, const Anchor& b, double stiffness, double length) {
  SpringDef spring;
  spring.a = a, spring.b = b;
  spring.stiffness = stiffness;
  spring.damping = 1;
  spring.rest_length = length;
  return spring;
}

Anchor particle(ParticleSystemId id, uint64_t which) {
  return {Anchor::Kind::particle, {}, id, which, Vec3::Zero()};
}

}  // namespace

TEST_CASE("a net of light particles and stiff springs gains no motion, and keeps its momentum" *
          doctest::test_suite("long")) {
  // Motion only: what a tick does not resolve may be stretched far at its end.
  for (const double stiffness : {200.0, 1e6, 1e12}) {
    TestWorld w(without_gravity());
    ParticleSystemDef def;
    def.fast = true;
    Random random(3);
    const auto vector = [&](double size) -> Vec3 {
      return size * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    };
    for (int i = 0; i < 30; ++i) {
      ParticleDef p;
      p.x = vector(0.15), p.v = vector(0.6);
      def.particles.push_back(p);
    }
    const auto id = w->create_particles(def);
    REQUIRE(id.ok());
    w.apply();
    int springs = 0;
    for (size_t i = 0; i < 30; ++i)
      for (size_t k = i + 1; k < 30; ++k) {
        const double apart = (def.particles[i].x - def.particles[k].x).norm();
        if (apart > 0.2) continue;
        w.force(between(particle(*id, i + 1), particle(*id, k + 1), stiffness, apart));
        ++springs;
      }
    CHECK(springs > 100);
    const StepStats start = w->frame()->stats;
    for (int tick = 0; tick < 300; ++tick) {
      w.step();
      const StepStats now = w->frame()->stats;
      REQUIRE(now.energies.kinetic < 1.05 * start.energies.total());
      REQUIRE((now.momentum - start.momentum).norm() < 1e-9 * start.momentum.norm());
    }
  }
}

TEST_CASE("event: a net stays bounded at any stiffness: in shorter steps, or time-stepped") {
  // 1 g a node. The fastest oscillations are of about 0.7, 16 and 2e4 rad a tick: the tick is a
  // step, it is eight, and it is more than are tried.
  struct Net {
    double stiffness;
    bool time_stepped;
  };
  for (const Net& net : {Net{0.1, false}, Net{60, false}, Net{1e8, true}}) {
    CAPTURE(net.stiffness);
    WorldSettings settings = without_gravity();
    settings.stepper = "event";
    TestWorld w(settings, 1, net.time_stepped ? "said once" : "");
    ParticleSystemDef def;
    def.collide = false;
    Random random(3);
    for (int i = 0; i < 25; ++i) {
      ParticleDef p;
      p.mass = 0.001;
      p.x = 0.1 * Vec3(i % 5, i / 5, 0);
      p.v = 0.3 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      def.particles.push_back(p);
    }
    const auto id = w->create_particles(def);
    REQUIRE(id.ok());
    w.apply();
    for (size_t i = 0; i < 25; ++i)
      for (size_t k = i + 1; k < 25; ++k) {
        const double apart = (def.particles[i].x - def.particles[k].x).norm();
        if (apart > 0.15) continue;
        SpringDef spring =
            between(particle(*id, i + 1), particle(*id, k + 1), net.stiffness, apart);
        spring.damping = 0;
        w.force(spring);
      }
    const StepStats start = w->frame()->stats;
    uint64_t time_stepped = 0;
    for (int tick = 0; tick < 60; ++tick) {
      time_stepped += w.step().stats.time_stepped;
      const StepStats now = w->frame()->stats;
      REQUIRE(now.energies.kinetic < 1.001 * start.energies.total());
      REQUIRE((now.momentum - start.momentum).norm() < 1e-9 * start.momentum.norm());
    }
    CHECK((time_stepped > 0) == net.time_stepped);
  }
}

TEST_CASE("a chain of stiff springs hangs as long as its weights stretch it") {
  WorldSettings s = without_gravity();
  s.gravity = Vec3(0, -9.81, 0);
  TestWorld w(s);
  ParticleSystemDef def;
  def.collide = false;
  for (int i = 0; i < 10; ++i) {
    ParticleDef p;
    p.x = Vec3(0, -0.1 * (i + 1), 0);
    p.mass = 0.01;
    def.particles.push_back(p);
  }
  const auto id = w->create_particles(def);
  REQUIRE(id.ok());
  w.apply();
  const double k = 500;
  for (uint64_t i = 0; i < 10; ++i)
    w.force(between(i == 0 ? Anchor{} : particle(*id, i), particle(*id, i + 1), k, 0.1));
  w.run(5);
  double bottom = 0;
  for (int i = 0; i < 10; ++i) bottom -= 0.1 + (10 - i) * 0.01 * 9.81 / k;
  CHECK(w->particles(*id)->x[9].y() == doctest::Approx(bottom).epsilon(1e-6));
}

TEST_CASE("a spring far out on a body, stretched far: it turns and swings, and stays bounded") {
  for (const double stiffness : {1e3, 1e6, 1e9})
    for (const Vec3& point : {Vec3(0.5, 0.5, 0.5), Vec3(0.5, 0, 0), Vec3(0, -0.5, 0)}) {
      TestWorld w(without_gravity());
      BodyDef def = TestWorld::box_def({0, 0, 0});
      def.mass = 1;
      const BodyId b = w.add(def);
      Anchor wall;
      wall.point = Vec3(0, 3, 0);
      w.force(between(wall, {Anchor::Kind::body, b, {}, 0, point}, stiffness, 1));
      const double start = w->frame()->stats.energies.total();
      for (int tick = 0; tick < 300; ++tick) {
        w.step();
        // It turns by more than a tick resolves: the leapfrog's energy wavers, and stays near.
        REQUIRE(w->frame()->stats.energies.kinetic < 1.5 * start);
      }
    }
}

TEST_CASE("energy out of nothing stops the run, names who has it, and gives back the last tick") {
  WorldSettings s = without_gravity();
  s.stepper = "event";
  s.event.integrator = "explicit_euler";
  TestWorld w(s);
  BodyDef def = TestWorld::sphere_def({0, 0, 0}, 0.1);
  def.name = "culprit";
  def.mass = 1;
  const BodyId b = w.add(def);
  Anchor wall;
  wall.point = Vec3(0, 1, 0);
  SpringDef spring = between(wall, {Anchor::Kind::body, b, {}, 0, Vec3::Zero()}, 1e4, 0.9);
  spring.damping = 0;
  w.force(spring);
  const double start = w->frame()->stats.energies.total();
  for (int tick = 0; tick < 1000; ++tick) {
    const uint64_t hash = w->state_hash();
    const auto report = w->step();
    if (report.ok()) {
      REQUIRE(w->frame()->stats.energies.total() < 1e5 * start);
      continue;
    }
    CHECK(report.error().code == ErrorCode::numeric);
    CHECK(report.error().text().find("culprit") != std::string::npos);
    CHECK(report.error().text().find("unstable") != std::string::npos);
    CHECK(w->state_hash() == hash);
    CHECK(w->tick() == uint64_t(tick));
    return;
  }
  FAIL("the run went on");
}

TEST_CASE("a strong constant force is no breakdown: the books know what it gives") {
  TestWorld w(without_gravity());
  const BodyId b = w.sphere({0, 0, 0}, 0.1);
  WindDef wind;
  wind.velocity = Vec3(1e5, 0, 0);
  wind.grip.rate = 1;
  w.force(wind);
  w.run(5);
  CHECK(w.body(b).v.x() > 9e4);
}

TEST_CASE("event: particles whose spring was too stiff are tried again as late as bodies are") {
  // The spring, and with it the group of two, is gone after the first tick; what was too much is
  // tried again after four.
  const auto ticks = [](bool particles, bool kept) {
    WorldSettings settings = without_gravity();
    settings.stepper = "event";
    TestWorld w(settings, 1, "said once");
    Anchor a, b;
    if (particles) {
      ParticleSystemDef def;
      for (const double x : {0.0, 1.0}) def.particles.emplace_back().x = {x, 0, 0};
      const auto id = w->create_particles(def);
      REQUIRE(id.ok());
      w.apply();
      a = particle(*id, 1), b = particle(*id, 2);
    } else {
      a.kind = b.kind = Anchor::Kind::body;
      a.body = w.add(TestWorld::sphere_def({0, 0, 0}, 0.1));
      b.body = w.add(TestWorld::sphere_def({1, 0, 0}, 0.1));
    }
    const ForceId spring = w.force(between(a, b, 1e15, 1));
    std::vector<uint64_t> out;
    for (int tick = 0; tick < 10; ++tick) {
      out.push_back(w.step().stats.time_stepped);
      if (tick == 0) REQUIRE(w->destroy_force(spring).ok());
      if (tick == 2 && kept) REQUIRE(w->load(w->save()).ok());
    }
    return out;
  };
  const std::vector<uint64_t> of_bodies = ticks(false, false);
  CHECK(of_bodies == std::vector<uint64_t>{1, 2, 2, 2, 2, 0, 0, 0, 0, 0});
  CHECK(ticks(true, false) == of_bodies);
  CHECK(ticks(true, true) == of_bodies);
}
