// The front door of the World: ids, validation, order of commands. Reference: what each command
// says.
#include "engine/dynamics/particles/fluid_def.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "engine/world/replay.hpp"
#include "tests/support/test_world.hpp"
#include "tests/support/why_not.hpp"

#include <algorithm>
#include <limits>

#include <doctest/doctest.h>

using namespace tumble;
using test::TestWorld;

TEST_CASE("an id is valid at once, its body after the commands are applied") {
  TestWorld w;
  auto id = w->create_body(TestWorld::sphere_def({0, 1, 0}));
  REQUIRE(id.ok());
  CHECK(w->body(*id) == nullptr);
  CHECK(w->set_velocity(*id, {1, 0, 0}, Vec3::Zero()).ok());
  REQUIRE(w->apply_commands().ok());
  REQUIRE(w->body(*id));
  CHECK(w->body(*id)->v.x() == 1);
}

TEST_CASE("stale ids are errors, also after their slot was reused") {
  TestWorld w;
  const BodyId a = w.sphere({0, 1, 0});
  REQUIRE(w->destroy_body(a).ok());
  CHECK_FALSE(w->destroy_body(a).ok());
  CHECK_FALSE(w->set_velocity(a, Vec3::Zero(), Vec3::Zero()).ok());
  const BodyId b = w.sphere({0, 2, 0});
  CHECK(b.index == a.index);
  CHECK(w->body(a) == nullptr);
  CHECK(w->body(b));
  CHECK_FALSE(w->destroy_body(a).ok());
  CHECK_FALSE(w->destroy_body(BodyId{}).ok());
  CHECK_FALSE(w->destroy_body(BodyId{1000000, 1}).ok());
}

TEST_CASE("bad definitions are refused with a reason and leave nothing behind") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  TestWorld w;
  const auto refused = [&](BodyDef def) {
    auto id = w->create_body(std::move(def));
    CHECK_FALSE(id.ok());
    if (!id.ok()) CHECK_FALSE(id.error().message.empty());
  };
  refused(TestWorld::sphere_def({0, 0, 0}, -1));
  refused(TestWorld::sphere_def({0, 0, 0}, nan));
  refused(TestWorld::sphere_def({nan, 0, 0}));
  refused(TestWorld::box_def({0, 0, 0}, {1, 0, 1}));
  BodyDef d = TestWorld::box_def({0, 0, 0});
  d.velocity.x() = std::numeric_limits<double>::infinity();
  refused(d);
  d = TestWorld::box_def({0, 0, 0});
  d.mass = 0;
  refused(d);
  ShapeDef half_space;
  half_space.type = ShapeType::half_space;
  refused(TestWorld::shape_def(half_space, {0, 0, 0}));  // dynamic
  CHECK_FALSE(w->create_force(LinearDragDef{-1, 0}).ok());
  CHECK_FALSE(w->create_force(LinearDragDef{nan, 0}).ok());
  SpringDef spring;
  spring.b.kind = Anchor::Kind::body;
  CHECK_FALSE(w->create_force(spring).ok());
  WorldSettings s;
  s.tick.num = 0;
  CHECK_FALSE(w->set_settings(s).ok());
  s = {};
  s.broad_phase = "uniform_gird";
  const Status status = w->set_settings(s);
  REQUIRE_FALSE(status.ok());
  CHECK(status.error().message.find("did you mean 'uniform_grid'") != std::string::npos);
  CHECK(w->frame()->body_slots() == 0);
}

TEST_CASE("a force of infinite size stops the run, names the body, and gives back the last tick") {
  TestWorld w;
  BodyDef def = TestWorld::sphere_def({0, 5, 0});
  def.name = "culprit";
  def.velocity = Vec3(1e200, 0, 0);
  const BodyId b = w.add(def);
  QuadraticDragDef drag;
  drag.fluid_density = 1e300;
  w.force(drag);
  const uint64_t hash = w->state_hash();
  const auto report = w->step();
  REQUIRE_FALSE(report.ok());
  CHECK(report.error().code == ErrorCode::numeric);
  CHECK(report.error().text().find("culprit") != std::string::npos);
  CHECK(w->state_hash() == hash);
  CHECK(w->tick() == 0);
  CHECK(w.body(b).v.x() == 1e200);
}

TEST_CASE("ticks are rational and time does not drift when the tick rate changes") {
  WorldSettings s;
  s.tick = {30000, 1001};
  TestWorld w(s);
  for (int i = 0; i < 30000; ++i) w.step();
  CHECK(w->time() == 1001.0);
  s.tick = {60, 1};
  REQUIRE(w->set_settings(s).ok());
  w.apply();
  w.run(1);
  CHECK(w->time() == 1002.0);
}

TEST_CASE("rays find the nearest body") {
  TestWorld w;
  w.ground();
  const BodyId a = w.sphere({0, 1, 0});
  w.box({0, 1, -5});
  const auto hit = w->ray_cast({0, 1, 10}, {0, 0, -2}, 100);
  REQUIRE(hit);
  CHECK(hit->body == a);
  CHECK(hit->distance == doctest::Approx(9.5));
  CHECK((hit->normal - Vec3::UnitZ()).norm() < 1e-12);
  CHECK_FALSE(w->ray_cast({0, 1, 10}, {0, 0, 1}, 100));
  CHECK_FALSE(w->ray_cast({0, 1, 10}, {0, 0, -1}, 9.4));
}

TEST_CASE("another definition for a body: it falls, weighs and is held as that says") {
  // Reference: a world in which it was so from the start.
  for (const char* stepper : {"realtime", "event"}) {
    CAPTURE(stepper);
    WorldSettings settings;
    settings.stepper = stepper;
    BodyDef small = TestWorld::sphere_def({0, 3, 0}, 0.2), large = small;
    large.shapes[0].shape.radius = 0.5;
    large.shapes[0].material.density = 200;
    large.velocity = {1, 0, 0};
    const auto run = [&](bool from_the_start) {
      TestWorld w(settings);
      const BodyId post = w.add([] {
        BodyDef def = TestWorld::box_def({0, 6, 0});
        def.type = BodyType::fixed;
        return def;
      }());
      const BodyId id = w.add(from_the_start ? large : small);
      JointDef rope;
      rope.a = post, rope.b = id;
      rope.frame_a.x = {0, -1, 0}, rope.frame_b.x = {0, 2, 0};
      REQUIRE(w->create_joint(rope).ok());
      if (!from_the_start) REQUIRE(w->set_body(id, large).ok());
      w.run(1);
      return w.body(id);
    };
    const RigidBody changed = run(false), made = run(true);
    CHECK(changed.mass == doctest::Approx(200 * 4 * M_PI / 3 * 0.125).epsilon(1e-12));
    CHECK((changed.pose.x - made.pose.x).norm() < 1e-12);
    CHECK((changed.v - made.v).norm() < 1e-12);
    CHECK(changed.pose.x.x() > 0.1);
  }
}

TEST_CASE("a body that gets another shape while others lie on it moves them, and is replayed") {
  TestWorld w;
  BodyDef floor = TestWorld::box_def({0, -0.5, 0}, {5, 0.5, 5});
  floor.type = BodyType::fixed;
  w.add(floor);
  const BodyId below = w.box({0, 0.5, 0}, {0.5, 0.5, 0.5});
  const BodyId above = w.box({0, 1.5, 0}, {0.5, 0.5, 0.5});
  w.run(2);
  const Moment before = w->moment();
  BodyDef def = *w->body_def(below);
  def.shapes[0].shape.half_extents = {0.5, 0.25, 0.5};
  def.pose.x.y() -= 0.25;
  REQUIRE(w->set_body(below, def).ok());
  w.run(2);
  CHECK(w.body(above).pose.x.y() == doctest::Approx(1).epsilon(0.01));
  CHECK(w.body(below).pose.x.y() == doctest::Approx(0.25).epsilon(0.01));
  const uint64_t hash = w->state_hash();
  // The log of commands leads to the same state again.
  const ReplayLog log = w->replay_log();
  const uint64_t end = w->tick();
  REQUIRE(w->restore(before).ok());
  for (const LoggedCommand& c : log.entries()) {
    if (c.tick < w->tick()) continue;
    while (w->tick() < c.tick) w.step();
    REQUIRE(w->submit(c.command).ok());
  }
  while (w->tick() < end) w.step();
  CHECK(w->state_hash() == hash);
  // What cannot be is refused, and changes nothing.
  def.mass = -1;
  CHECK_FALSE(w->set_body(below, def).ok());
  CHECK_FALSE(w->set_body(BodyId{}, *w->body_def(above)).ok());
  CHECK(w->state_hash() == hash);
}

TEST_CASE(
    "a mesh that only a changed body has is in snapshots with waiting commands, and in replays") {
  TestWorld w;
  const BodyId id = w.box({0, 1, 0});
  BodyDef def = *w->body_def(id);
  ShapeDef tetrahedron;
  tetrahedron.type = ShapeType::triangle_mesh;
  tetrahedron.mesh = std::make_shared<const TriangleMesh>(make_mesh::tetrahedron(0.4));
  def.shapes[0].shape = tetrahedron;
  REQUIRE(w->set_body(id, def).ok());
  const Bytes waiting = w->save();
  w.run(0.2);
  TestWorld other;
  REQUIRE(other->load(waiting).ok());
  other.run(0.2);
  CHECK(other->state_hash() == w->state_hash());
  const auto played = run_replay(save_replay(*w.world));
  REQUIRE_MESSAGE(played.ok(), test::why_not(played));
  CHECK(played->same);
}

TEST_CASE("particles and emitters get other definitions, and keep their ids") {
  TestWorld w;
  ParticleSystemDef dust;
  dust.name = "dust";
  dust.detect = true;
  dust.particles = {{{0, 1, 0}}, {{0, 2, 0}}};
  const ParticleSystemId id = *w->create_particles(dust);
  EmitterDef spark, jet;
  spark.name = "spark";
  spark.particles = jet.particles = id;
  const EmitterId spark_id = *w->create_emitter(spark);
  jet.name = "jet";
  jet.rate = 60;
  jet.at_most = 100;
  spark.at_most = 100;
  jet.pose.x = Vec3(9, 9, 9);
  jet.events.push_back({SpawnRule::On::collision, spark_id, 1, 0, true});
  const EmitterId jet_id = *w->create_emitter(jet);
  for (int n = 0; n < 5; ++n) w.step();
  REQUIRE(w->particles(id)->size() == 7);
  // Kept: what there is moves on, by number with other values.
  const Vec3 x = w->particles(id)->x[0];
  dust.friction = 0.1;
  dust.particles[0].mass = 5;
  REQUIRE(w->set_particles(id, dust, true).ok());
  w.apply();
  CHECK(w->particles(id)->size() == 7);
  CHECK(w->particles(id)->x[0] == x);
  CHECK(w->particles(id)->mass[0] == 5);
  CHECK(w->particles(id)->mass[1] == 0.001);
  // Anew: those of the definition alone, and the emitter has none of its own.
  REQUIRE(w->set_particles(id, dust).ok());
  w.apply();
  CHECK(w->particles(id)->size() == 2);
  CHECK(w->particles(id)->x[0] == Vec3(0, 1, 0));
  CHECK(w->particles(id)->id[0] == 1);
  CHECK(w->emitter(jet_id)->alive == 0);
  // The rate counts from the beginning of the emitter.
  jet.rate = 120;
  REQUIRE(w->set_emitter(jet_id, jet).ok());
  for (int n = 0; n < 5; ++n) w.step();
  CHECK(w->particles(id)->size() == 12);
  // What would leave an event without its cause, or lead in a circle, is refused.
  dust.detect = false;
  CHECK_FALSE(w->set_particles(id, dust).ok());
  spark.events.push_back({SpawnRule::On::death, jet_id, 1, 0, false});
  const Status circle = w->set_emitter(spark_id, spark);
  REQUIRE_FALSE(circle.ok());
  CHECK(circle.error().message.find("back to it") != std::string::npos);
  CHECK_FALSE(w->set_particles({77, 1}, dust).ok());
  CHECK_FALSE(w->set_emitter({77, 1}, jet).ok());
  const auto played = run_replay(save_replay(*w.world));
  REQUIRE_MESSAGE(played.ok(), test::why_not(played));
  CHECK(played->world->state_hash() == w->state_hash());
  // Commands that wait are saved, too.
  dust.detect = true;
  dust.particles.clear();
  REQUIRE(w->set_particles(id, dust).ok());
  REQUIRE(w->set_emitter(jet_id, jet).ok());
  TestWorld other;
  REQUIRE(other->load(w->save()).ok());
  w.step();
  other.step();
  CHECK(other->state_hash() == w->state_hash());
}

TEST_CASE("values that are kept are not those of emitted particles, whatever their numbers") {
  TestWorld w;
  ParticleSystemDef dust;
  dust.particles = {{{0, 1, 0}}};
  const ParticleSystemId id = *w->create_particles(dust);
  EmitterDef jet;
  jet.particles = id;
  jet.rate = 60;
  jet.at_most = 3;
  jet.pose.x = Vec3(9, 9, 9);
  REQUIRE(w->create_emitter(jet).ok());
  for (int n = 0; n < 5; ++n) w.step();
  REQUIRE(w->particles(id)->size() == 4);
  const ParticleSystem was = *w->particles(id);
  dust.particles.resize(4, {{0, 1, 0}});
  for (ParticleDef& p : dust.particles) p.mass = 5;
  REQUIRE(w->set_particles(id, dust, true).ok());
  w.apply();
  const ParticleSystem& is = *w->particles(id);
  for (size_t i = 0; i < is.size(); ++i)
    CHECK(is.mass[i] == (was.emitter[i].is_null() ? 5 : was.mass[i]));
}

TEST_CASE("particles that were a fluid have no pressure, before a snapshot and after") {
  TestWorld w;
  ParticleSystemDef water;
  water.collide = false;
  water.fluid = std::make_shared<const FluidDef>();
  for (int i = 0; i < 64; ++i) {
    ParticleDef p;
    p.x = 0.05 * Vec3(i % 4, 10 + i / 4 % 4, i / 16);
    p.v = -p.x;  // pressed together
    p.mass = 1000 * 0.05 * 0.05 * 0.05;
    p.radius = 0.025;
    water.particles.push_back(p);
  }
  const ParticleSystemId id = *w->create_particles(water);
  w.step();
  const auto pressed = [&](World& world) {
    return std::ranges::any_of(world.particles(id)->pressure, [](double p) { return p != 0; });
  };
  REQUIRE(pressed(*w.world));
  water.fluid = nullptr;
  REQUIRE(w->set_particles(id, water, true).ok());
  w.apply();
  CHECK_FALSE(pressed(*w.world));
}

TEST_CASE("a circle of events is looked for once at each emitter, however many ways lead there") {
  TestWorld w;
  const ParticleSystemId id = *w->create_particles({});
  std::vector<EmitterId> chain;
  EmitterDef def;
  def.particles = id;
  for (int n = 0; n < 60; ++n) {  // 2^60 ways
    def.events.clear();
    for (int way = 0; way < 2 && n > 0; ++way)
      def.events.push_back({SpawnRule::On::death, chain.back(), 1, 0, false});
    chain.push_back(*w->create_emitter(def));
  }
  CHECK(w->set_emitter(chain.back(), def).ok());
  def.events.back().emitter = chain.back();
  CHECK_FALSE(w->set_emitter(chain.front(), def).ok());
}
