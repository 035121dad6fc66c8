// Emitters and sinks of bodies. References: integer arithmetic for counts, closed forms of free
// fall, and worlds loaded from snapshots, replayed and of other thread counts.
#include "engine/world/replay.hpp"
#include "tests/support/test_world.hpp"
#include "tests/support/why_not.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace tumble;
using namespace tumble::test;

namespace {

EmitterDef feeder(double rate) {
  EmitterDef def;
  def.name = "part";
  def.body = std::make_shared<const BodyDef>(TestWorld::box_def({0, 0, 0}, {0.1, 0.1, 0.1}));
  def.pose.x = {0, 3, 0};
  def.rate = rate;
  def.at_most = 100;
  return def;
}

EmitterId emitter(TestWorld& w, const EmitterDef& def) {
  const auto id = w->create_emitter(def);
  REQUIRE_MESSAGE(id.ok(), test::why_not(id));
  w.apply();
  return *id;
}

void fill(TestWorld& w) {
  w.ground();
  EmitterDef def = feeder(6);
  def.shape = DiscEmission{0.3};
  def.any_orientation = true;
  def.spin = {4, 2};
  def.speed = {-1};
  def.colours = {Vec3f(1, 0, 0), Vec3f(0, 1, 0)};
  emitter(w, def);
  SinkDef sink;
  sink.region = BoxSink{{0.5, 4, 4}};
  sink.pose.x = {0.55, 0, 0};
  sink.takes_bodies = true;
  REQUIRE(w->create_sink(sink).ok());
  w.apply();
}

}  // namespace

TEST_CASE("bodies are emitted by the count of the rate, and fall") {
  TestWorld w;
  const EmitterId id = emitter(w, feeder(7));
  for (uint64_t n = 1; n <= 90; ++n) {
    w.step();
    REQUIRE(w->frame()->stats.bodies == 7 * n / 60);
  }
  CHECK(w->emitter(id)->bodies.size() == 10);
  const RigidBody* first = w->body(w->find_body("part[0]"));
  REQUIRE(first);
  CHECK(first->pose.x.y() < -4);
  CHECK(w->frame()->info(w->find_body("part[3]").index).mass == doctest::Approx(8));
}

TEST_CASE("emitted bodies: the same bits for any number of threads, after a snapshot, in replay" *
          doctest::test_suite("long")) {
  for (const char* stepper : {"realtime", "event"}) {
    CAPTURE(stepper);
    WorldSettings settings;
    settings.stepper = stepper;
    settings.event.budget = 1000;
    std::vector<uint64_t> hashes;
    const double seconds = std::string(stepper) == "event" ? 0.8 : 2;
    for (const int threads : {1, 2, 4}) {
      TestWorld w(settings, threads);
      fill(w);
      w.run(seconds);
      // Ids that the outside is given interleave with those of the emitter.
      const BodyId mine = w.sphere({-3, 0.5, 0});
      const Bytes saved = w->save();
      TestWorld later(settings, 1);
      REQUIRE(later->load(saved).ok());
      w.run(seconds);
      later.run(seconds);
      hashes.push_back(w->state_hash());
      CHECK(later->state_hash() == hashes.back());
      CHECK(w->body(mine) != nullptr);
      if (threads > 1) continue;
      const auto replayed = run_replay(save_replay(*w.world));
      REQUIRE(replayed.ok());
      CHECK(replayed->same);
    }
    CHECK(hashes[1] == hashes[0]);
    CHECK(hashes[2] == hashes[0]);
  }
}

TEST_CASE("a sink takes bodies, and their emitter makes more, the books have both") {
  TestWorld w;
  EmitterDef def = feeder(4);  // they have fallen out of each other's way
  def.at_most = 3;
  const EmitterId id = emitter(w, def);
  SinkDef sink;
  sink.pose.x = {0, -2, 0};
  sink.takes_bodies = true;
  sink.takes_particles = false;
  REQUIRE(w->create_sink(sink).ok());
  for (int n = 0; n < 240; ++n) {
    w.step();
    CHECK(w->frame()->stats.bodies <= 3);
    CHECK(w->emitter(id)->bodies.size() == w->frame()->stats.bodies);
  }
  CHECK(w->emitter(id)->made > 8);
  const auto frame = w->frame();
  const Ledger& ledger = *frame->ledger;
  const auto made = double(w->emitter(id)->made);
  CHECK(ledger.line(LedgerLine::emission).total().balance ==
        doctest::Approx(made * 8 * 9.81 * 3).epsilon(1e-9));
  CHECK(ledger.line(LedgerLine::removal).total().momentum.y() > 0);
  CHECK(std::fabs(ledger.line(LedgerLine::edits).total().balance) < 1e-9);
  CHECK(std::fabs(ledger.line(LedgerLine::integrator).total().balance) <
        1e-9 * ledger.throughput());
}

TEST_CASE("emitted bodies die at the end of their life, also in a world at rest") {
  TestWorld w;
  w.ground();
  EmitterDef def = feeder(0);
  def.bursts = {{0.5, 1}};
  def.pose.x = {0, 0.1, 0};
  def.life = {4};
  emitter(w, def);
  w.run(4.45);
  CHECK(w->frame()->stats.bodies == 2);
  CHECK(w->frame()->stats.awake == 0);
  w.run(0.1);
  CHECK(w->frame()->stats.bodies == 1);
}

TEST_CASE("a carried emitter throws bodies with the carrier's velocity") {
  WorldSettings settings;
  settings.gravity = Vec3::Zero();
  TestWorld w(settings);
  BodyDef cart = TestWorld::box_def({0, 0, 0});
  cart.type = BodyType::kinematic;
  cart.velocity = {3, 0, 0};
  EmitterDef def = feeder(0);
  def.carrier = w.add(cart);
  def.speed = {2};
  def.bursts = {{1, 1}};
  emitter(w, def);
  w.run(1);
  const RigidBody* b = w->body(w->find_body("part[0]"));
  REQUIRE(b);
  CHECK((b->v - Vec3(3, 2, 0)).norm() < 1e-12);
  CHECK(b->pose.x.x() == doctest::Approx(3).epsilon(0.02));
}

namespace {

ParticleSystemId smoke_of(TestWorld& w) {
  ParticleSystemDef def;
  def.name = "smoke";
  def.collide = false;
  def.gravity_scale = 0;
  const auto id = w->create_particles(def);
  REQUIRE(id.ok());
  w.apply();
  return *id;
}

/// Puffs that stay where they are.
EmitterId puffs(TestWorld& w, ParticleSystemId smoke, double inherit = 0) {
  EmitterDef def;
  def.name = "puff";
  def.particles = smoke;
  def.life = {100};
  def.inherit = inherit;
  def.at_most = 10000;
  return emitter(w, def);
}

}  // namespace

TEST_CASE("bodies leave particles at birth, along their way and at death, where they are then") {
  TestWorld w;
  const ParticleSystemId smoke = smoke_of(w);
  const EmitterId puff = puffs(w, smoke);
  EmitterDef def = feeder(0);
  def.bursts = {{0, 1, 1, 1}};
  def.speed = {4};
  def.life = {0.5};
  def.events = {{SpawnRule::On::birth, puff, 2, 0, false},
                {SpawnRule::On::life, puff, 1, 40, false},
                {SpawnRule::On::death, puff, 5, 0, false}};
  emitter(w, def);
  w.run(0.7);
  CHECK(w->frame()->stats.bodies == 0);
  const ParticleSystem& p = *w->particles(smoke);
  // At 1/40 s, 2/40 s ... until the tick that its life ends in, before which it goes; in a tick it
  // goes straight.
  REQUIRE(p.size() == 2 + 19 + 5);
  const auto height = [](double t) { return 3 + 4 * t - 0.5 * 9.81 * t * t; };
  const double rough = 0.5 * 9.81 / 60 / 60;
  CHECK(std::ranges::count_if(p.x, [&](const Vec3& x) { return x.y() == 3; }) == 2);
  for (int k = 1; k <= 19; ++k) {
    const double y = height(k / 40.0);
    CHECK(std::ranges::any_of(p.x, [&](const Vec3& x) { return std::fabs(x.y() - y) < rough; }));
  }
  CHECK(std::ranges::count_if(
            p.x, [&](const Vec3& x) { return std::fabs(x.y() - height(0.5)) < 4.0 / 60; }) >= 5);
}

TEST_CASE("a body gives birth as often as its rate has it, in the ticks that are due") {
  WorldSettings settings;
  settings.gravity = Vec3::Zero();
  settings.tick = {240, 1};
  TestWorld w(settings);
  EmitterDef smoke;
  smoke.name = "puff";
  smoke.particles = smoke_of(w);
  smoke.life = {0.1};
  const EmitterId puff = emitter(w, smoke);
  EmitterDef def = feeder(0);
  def.bursts = {{0, 1, 1, 1}};
  def.speed = {1};
  def.events = {{SpawnRule::On::life, puff, 1, 60, false}};
  emitter(w, def);
  for (uint64_t n = 1; n <= 2400; ++n) {
    w.step();
    REQUIRE(w->emitter(puff)->made == n / 4);
  }
}

TEST_CASE("a body that strikes the ground raises dust there once, and again when it comes back") {
  for (const char* stepper : {"realtime", "event"}) {
    CAPTURE(stepper);
    WorldSettings settings;
    settings.stepper = stepper;
    TestWorld w(settings);
    w.ground();
    const ParticleSystemId smoke = smoke_of(w);
    const EmitterId puff = puffs(w, smoke);
    EmitterDef def = feeder(0);
    def.pose.x = {0.5, 1, 0};
    def.bursts = {{0, 1, 1, 1}};
    def.events = {{SpawnRule::On::collision, puff, 4, 0, false}};
    emitter(w, def);
    w.run(0.4);  // it would fall for 0.428 s
    CHECK(w->emitter(puff)->made == 0);
    w.run(1.6);
    CHECK(w->emitter(puff)->made == 4);
    for (const Vec3& x : w->particles(smoke)->x) {
      CHECK(std::fabs(x.y()) < 0.02);
      CHECK(std::fabs(x.x() - 0.5) < 0.11);
    }
    const BodyId part = w->find_body("part[0]");
    REQUIRE(w->set_pose(part, Pose{{3, 0.5, 0}, Quat::Identity()}).ok());
    w.run(1);
    CHECK(w->emitter(puff)->made == 8);
  }
}

TEST_CASE("particles give birth to bodies, bodies to bodies, and a body dies of a collision") {
  TestWorld w;
  w.ground();
  const ParticleSystemId smoke = smoke_of(w);
  EmitterDef chip = feeder(0);
  chip.name = "chip";
  chip.pose.x.setZero();
  chip.shape = SphereEmission{0.3};
  chip.life = {0.5};
  const EmitterId chips = emitter(w, chip);
  EmitterDef crate = feeder(0);
  crate.name = "crate";
  crate.pose.x.setZero();
  crate.events = {{SpawnRule::On::collision, chips, 3, 0, true},
                  {SpawnRule::On::death, chips, 2, 0, false}};
  const EmitterId crates = emitter(w, crate);
  EmitterDef rocket;
  rocket.name = "rocket";
  rocket.particles = smoke;
  rocket.bursts = {{0, 1, 1, 1}};
  rocket.life = {0.5};
  rocket.speed = {4};
  rocket.events = {{SpawnRule::On::death, crates, 1, 0, false}};
  emitter(w, rocket);
  w.run(0.5);
  CHECK(w->emitter(crates)->made == 0);
  w.run(2.0 / 60);
  REQUIRE(w->emitter(crates)->made == 1);
  const RigidBody* body = w->body(w->find_body("crate[0]"));
  REQUIRE(body);
  CHECK(body->pose.x.y() == doctest::Approx(4 * 0.5).epsilon(0.1));
  CHECK(body->v.y() == doctest::Approx(4).epsilon(0.1));
  const Bytes saved = w->save();
  w.run(1.2);  // it rises 0.8 m, falls 2.8 m: 1.17 s
  CHECK(w->emitter(chips)->made == 5);
  CHECK(w->find_body("crate[0]").is_null());
  TestWorld later;
  REQUIRE(later->load(saved).ok());
  later.run(1.2);
  CHECK(later->state_hash() == w->state_hash());
  w.run(1);
  CHECK(w->emitter(chips)->bodies.empty());
}

TEST_CASE("a body that leaves the ground by less than it rattles does not strike it anew") {
  TestWorld w;
  w.ground();
  const EmitterId puff = puffs(w, smoke_of(w));
  EmitterDef def = feeder(0);
  def.pose.x = {0, 0.15, 0};
  def.bursts = {{0, 1, 1, 1}};
  def.events = {{SpawnRule::On::collision, puff, 1, 0, false}};
  emitter(w, def);
  w.run(0.4);
  REQUIRE(w->emitter(puff)->made == 1);
  const BodyId part = w->find_body("part[0]");
  const auto lift = [&](double height) {
    Pose pose = w.body(part).pose;
    pose.x.y() += height;
    REQUIRE(w->set_pose(part, pose).ok());
    w.run(0.4);
  };
  const double fall = 9.81 / 60 / 60;  // g h^2
  lift(0.8 * fall);
  CHECK(w->emitter(puff)->made == 1);
  lift(8 * fall);
  CHECK(w->emitter(puff)->made == 2);
}

TEST_CASE("a shell that lands on two tiles at once bursts once") {
  TestWorld w;
  for (const double x : {-0.5, 0.5}) {
    BodyDef tile = TestWorld::box_def({x, -0.1, 0}, {0.5, 0.1, 0.5});
    tile.type = BodyType::fixed;
    w.add(tile);
  }
  const ParticleSystemId smoke = smoke_of(w);
  const EmitterId puff = puffs(w, smoke), spark = puffs(w, smoke);
  EmitterDef shell = feeder(0);
  shell.pose.x = {0, 0.3, 0};
  shell.bursts = {{0, 1, 1, 1}};
  shell.events = {{SpawnRule::On::collision, puff, 3, 0, true},
                  {SpawnRule::On::collision, spark, 1, 0, false}};
  emitter(w, shell);
  w.run(0.5);  // it falls for 0.2 s
  CHECK(w->find_body("part[0]").is_null());
  CHECK(w->emitter(puff)->made == 3);
  CHECK(w->emitter(spark)->made == 1);  // all rules of the one collision
}

TEST_CASE("a body that a sink takes calls for others, in the same bits for any threads") {
  std::vector<uint64_t> hashes;
  for (const int threads : {1, 4}) {
    TestWorld w({}, threads);
    const ParticleSystemId smoke = smoke_of(w);
    const EmitterId puff = puffs(w, smoke, 0.5);
    EmitterDef def = feeder(12);
    def.events = {{SpawnRule::On::sink, puff, 3, 0, false}};
    emitter(w, def);
    SinkDef sink;
    sink.takes_bodies = true;
    sink.takes_particles = false;
    REQUIRE(w->create_sink(sink).ok());
    w.run(2);
    CHECK(w->emitter(puff)->made > 0);
    CHECK(w->emitter(puff)->made % 3 == 0);
    hashes.push_back(w->state_hash());
  }
  CHECK(hashes[0] == hashes[1]);
}
