// What rests notices that the forces on it have changed. Reference: which way a body must go under
// the new force, and that what cannot move it leaves it asleep.
#include "tests/support/test_world.hpp"

#include <doctest/doctest.h>

using namespace tumble;
using test::TestWorld;

namespace {

/// A box asleep on the ground.
struct Resting {
  TestWorld w;
  BodyId box;
  Resting() {
    w.ground();
    box = w.box({0, 0.5, 0});
    w.run(3);
    REQUIRE(w.body(box).asleep);
  }
  void settings(void (*change)(WorldSettings&)) {
    WorldSettings s = w->settings();
    change(s);
    REQUIRE(w->set_settings(s).ok());
  }
  double speed() { return w.body(box).v.norm(); }
};

SpringDef spring_up(BodyId body) {
  SpringDef spring;
  spring.a.point = {0, 3, 0};
  spring.b.kind = Anchor::Kind::body;
  spring.b.body = body;
  spring.stiffness = 1;
  spring.rest_length = 2.5;
  return spring;
}

}  // namespace

TEST_CASE("gravity that turns round lifts what slept") {
  Resting r;
  r.settings([](WorldSettings& s) { s.gravity = {0, 2, 0}; });
  r.w.run(0.5);
  CHECK(r.w.body(r.box).v.y() == doctest::Approx(1.0).epsilon(0.05));
}

TEST_CASE("settings that do not touch the rest leave it asleep, sleep switched off wakes it") {
  Resting r;
  r.settings([](WorldSettings& s) { s.realtime.substeps = 8; });
  r.w.step();
  CHECK(r.w.body(r.box).asleep);
  r.settings([](WorldSettings& s) { s.realtime.sleeping = false; });
  r.w.run(2);
  CHECK_FALSE(r.w.body(r.box).asleep);
}

TEST_CASE("a spring made, stiffened and cut is noticed") {
  Resting r;
  const ForceId id = r.w.force(spring_up(r.box));
  r.w.run(3);
  REQUIRE(r.w.body(r.box).asleep);
  SpringDef strong = spring_up(r.box);
  strong.stiffness = 1e5;
  strong.rest_length = 0.5;
  REQUIRE(r.w->set_force(id, strong).ok());
  r.w.step();
  CHECK_FALSE(r.w.body(r.box).asleep);
  r.w.run(8);
  CHECK(r.w.body(r.box).pose.x.y() > 1);
  REQUIRE(r.w->destroy_force(id).ok());
  const double rising = r.w.body(r.box).v.y();  // it swings on the spring
  r.w.run(0.2);
  CHECK(r.w.body(r.box).v.y() - rising == doctest::Approx(-9.81 * 0.2).epsilon(0.01));
}

TEST_CASE("wind that rises moves what slept, drag of still air does not") {
  Resting r;
  QuadraticDragDef air;
  const ForceId id = r.w.force(air);
  r.w.step();
  CHECK(r.w.body(r.box).asleep);
  air.wind = {200, 0, 0};
  REQUIRE(r.w->set_force(id, air).ok());
  r.w.run(0.5);
  CHECK(r.w.body(r.box).v.x() > 0.1);
}

TEST_CASE("a particle on a spring keeps the body at the other end awake, and pulls it") {
  Resting r;
  ParticleSystemDef particles;
  particles.particles.push_back({});
  particles.particles[0].x = {0, 1.5, 0};
  particles.particles[0].mass = 1;
  auto system = r.w->create_particles(particles);
  REQUIRE(system.ok());
  r.w.apply();
  SpringDef spring = spring_up(r.box);
  spring.a.kind = Anchor::Kind::particle;
  spring.a.particles = *system;
  spring.rest_length = 1;
  r.w.force(spring);
  r.w.run(3);
  CHECK_FALSE(r.w.body(r.box).asleep);
}

TEST_CASE("what was made asleep falls with what carried it, through all layers") {
  // Reference: nothing is left in the air.
  TestWorld w;
  w.ground();
  const auto sleeper = [&w](const Vec3& x, const Vec3& half) {
    BodyDef def = TestWorld::box_def(x, half);
    def.starts_asleep = true;
    return w.add(def);
  };
  sleeper({0, 0.5, 0}, {0.25, 0.5, 0.25});  // the post
  std::vector<BodyId> carried{sleeper({0, 1.1, 0}, {1.5, 0.1, 1.5})};
  for (int layer = 0; layer < 3; ++layer)
    for (const double x : {-1.2, 0.0, 1.2})
      carried.push_back(sleeper({x, 1.3 + 0.2 * layer, 0.9}, {0.1, 0.1, 0.1}));
  w.run(0.5);
  REQUIRE(w->frame()->stats.awake == 0);
  BodyDef ball = TestWorld::sphere_def({-3, 0.5, 0}, 0.4);
  ball.mass = 2000;
  ball.velocity = {40, 0, 0};
  w.add(ball);
  w.run(3);
  for (const BodyId id : carried) CHECK(w.body(id).pose.x.y() < 0.9);
}

TEST_CASE(
    "what sleeps is not looked at: a ball that rolls among sleepers compares what is near it" *
    doctest::test_suite("long")) {
  // Reference: all pairs would be half a million, one look at each sleeper a thousand.
  TestWorld w;
  w.ground();
  for (int i = 0; i < 32; ++i)
    for (int k = 0; k < 32; ++k) w.box({1.5 * i, 0.5, 1.5 * k});
  w.run(3);
  REQUIRE(w->frame()->stats.awake == 0);
  BodyDef ball = TestWorld::sphere_def({0.75, 0.2, 0.75}, 0.2);
  ball.velocity = {2, 0, 0};
  w.add(ball);
  w.run(0.1);  // the tick of the command looks at all
  for (int k = 0; k < 60; ++k) {
    w.step();
    CHECK(w->frame()->stats.awake == 1);
    CHECK(w->frame()->stats.bounds_tested < 100);
    CHECK(w->frame()->stats.contacts > 32 * 32);
  }
}
