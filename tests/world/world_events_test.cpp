// The list of what happens. References: closed forms of a bouncing ball; what the test itself does
// to the world.
#include "engine/world/events/gather_events.hpp"
#include "tests/support/test_world.hpp"

#include <algorithm>
#include <cmath>

using namespace tumble;
using namespace tumble::test;

namespace {

struct Watched {
  EventGatherer gatherer;
  EventLog log;

  explicit Watched(TestWorld& w) { gatherer.go_to(*w->frame()); }
  void run(TestWorld& w, int ticks) {
    for (int i = 0; i < ticks; ++i) {
      w.step();
      log.add(gatherer.see(*w->frame()));
    }
  }
  std::vector<WorldEvent> of(WorldEventKind kind) const {
    std::vector<WorldEvent> out;
    for (const WorldEvent& e : log.events())
      if (e.kind == kind) out.push_back(e);
    return out;
  }
};

BodyDef named_ball(const char* name, const Vec3& x, double restitution) {
  BodyDef def = TestWorld::sphere_def(x);
  def.name = name;
  def.mass = 3;
  def.shapes[0].material.restitution = restitution;
  return def;
}

}  // namespace

TEST_CASE("bounces of a ball are impacts, of m (v + v'), a box that rests makes none") {
  for (const char* stepper : {"realtime", "event"}) {
    CAPTURE(stepper);
    WorldSettings settings;
    settings.stepper = stepper;
    TestWorld w(settings);
    w.ground();
    w.add(named_ball("ball", {0, 1.5, 0}, 0.5));
    w.box({4, 0.5, 0});
    w.box({4, 1.5, 0});
    Watched watched(w);
    watched.run(w, 70);  // with the second bounce at .90 s and the third at 1.13 s
    const double g = 9.81, v = std::sqrt(2 * g), t = v / g;
    const std::vector<WorldEvent> impacts = watched.of(WorldEventKind::impact);
    REQUIRE(impacts.size() >= (settings.stepper == "event" ? 3 : 2));
    CHECK(impacts.size() <= 3);
    const double at[] = {t, 2 * t, 2.5 * t}, speed[] = {v, 0.5 * v, 0.25 * v};
    for (size_t k = 0; k < impacts.size(); ++k) {
      CAPTURE(k);
      // Realtime strikes up to a tick early or late, and later bounces inherit that.
      CHECK(std::fabs(impacts[k].time - at[k]) < double(k + 1) / 30);
      CHECK(impacts[k].impulse == doctest::Approx(3 * 1.5 * speed[k]).epsilon(0.12));
      CHECK((impacts[k].name_a == "ball" || impacts[k].name_b == "ball"));
      CHECK(std::fabs(impacts[k].x_world.y()) < 0.02);
    }
  }
}

TEST_CASE("what strikes is judged by the gravity that is usual, where it follows a course") {
  // A ball of .1 m/s between two walls, while there is no gravity: a strike where there never is
  // any, and none where gravity only happens to be zero, as on a course that swings.
  const auto strikes = [](VaryingVec3 gravity) {
    WorldSettings settings;
    settings.gravity = std::move(gravity);
    TestWorld w(settings);
    BodyDef wall = TestWorld::box_def({0, 0, 0});
    wall.type = BodyType::fixed;
    w.add(wall);
    BodyDef ball = named_ball("ball", {1.05, 0, 0}, 1);
    ball.velocity = Vec3(-0.1, 0, 0);
    w.add(ball);
    Watched watched(w);
    watched.run(w, 60);
    CHECK(w.world->frame()->gravity == Vec3::Zero());
    return watched.of(WorldEventKind::impact).size();
  };
  auto none = TimeCourse::expression("0*t");
  REQUIRE(none.ok());
  CHECK(strikes(Vec3::Zero()) == 1);
  CHECK(strikes({0, *std::move(none), 0}) == 0);
}

TEST_CASE("sleep, waking, births and deaths are told, of many at once together") {
  TestWorld w;
  w.ground();
  std::vector<BodyId> row;
  for (int k = 0; k < 12; ++k) row.push_back(w.box({2.0 * k, 0.5, 0}));
  Watched watched(w);
  watched.run(w, 300);
  REQUIRE(w->frame()->stats.awake == 0);
  uint64_t asleep = 0;
  for (const WorldEvent& e : watched.of(WorldEventKind::fell_asleep)) asleep += e.count;
  CHECK(asleep == 12);
  CHECK(watched.of(WorldEventKind::impact).empty());
  REQUIRE(w->apply_impulse(row[3], {1, 0, 0}, {6, 0.5, 0}).ok());
  watched.run(w, 1);
  const std::vector<WorldEvent> woken = watched.of(WorldEventKind::woke);
  REQUIRE(woken.size() == 1);
  CHECK(woken[0].a == row[3]);
  for (int k = 0; k < 10; ++k) REQUIRE(w->destroy_body(row[size_t(k)]).ok());
  REQUIRE(w->create_body(named_ball("late", {0, 9, 0}, 0)).ok());
  watched.run(w, 1);
  const std::vector<WorldEvent> deaths = watched.of(WorldEventKind::deaths);
  REQUIRE(deaths.size() == 1);
  CHECK(deaths[0].count == 10);
  REQUIRE(watched.of(WorldEventKind::births).size() == 1);
  CHECK(watched.of(WorldEventKind::births)[0].name_a == "late");
}

TEST_CASE("a joint that breaks is told of by its name, one that is taken away is not") {
  TestWorld w;
  JointDef weak;
  weak.name = "weak";
  weak.kind = JointKind::rigid;
  weak.b = w.box({0, 5, 0});
  weak.frame_a.x = Vec3(0, 5, 0);
  weak.break_force = 100;  // less than its weight
  JointDef strong = weak;
  strong.name = "strong";
  strong.b = w.box({3, 5, 0});
  strong.frame_a.x = Vec3(3, 5, 0);
  strong.break_force = 1e9;
  REQUIRE(w->create_joint(weak).ok());
  const auto kept = w->create_joint(strong);
  REQUIRE(kept.ok());
  w.apply();
  Watched watched(w);
  watched.run(w, 10);
  const std::vector<WorldEvent> broken = watched.of(WorldEventKind::joint_broken);
  REQUIRE(broken.size() == 1);
  CHECK(broken[0].name_a == "weak");
  REQUIRE(w->destroy_joint(*kept).ok());
  watched.run(w, 3);
  CHECK(watched.of(WorldEventKind::joint_broken).size() == 1);
}

TEST_CASE("births and deaths of particles are counted, in the same tick too") {
  TestWorld w;
  ParticleSystemDef dust;
  dust.name = "dust";
  dust.collide = false;
  const auto system = w->create_particles(dust);
  REQUIRE(system.ok());
  EmitterDef jet;
  jet.name = "jet";
  jet.particles = *system;
  jet.rate = 180;
  jet.life = {0.1};
  REQUIRE(w->create_emitter(jet).ok());
  w.apply();
  Watched watched(w);
  watched.run(w, 60);
  uint64_t born = 0, died = 0;
  for (const WorldEvent& e : watched.of(WorldEventKind::births)) born += e.count;
  for (const WorldEvent& e : watched.of(WorldEventKind::deaths)) died += e.count;
  CHECK(born == 180);
  CHECK(born - died == w->particles(*system)->size());
  CHECK(died > 150);
}

TEST_CASE("the list is bounded, forgets what has not happened, and is filtered") {
  EventLog log;
  for (uint64_t tick = 1; tick <= 10000; ++tick) {
    WorldEvent e;
    e.tick = tick;
    e.kind = tick % 2 == 0 ? WorldEventKind::impact : WorldEventKind::woke;
    e.name_a = tick % 4 == 0 ? "Crate[3]" : "ball";
    e.impulse = 0.001 * double(tick);
    log.add({e});
  }
  CHECK(log.events().size() <= EventLog::most);
  CHECK(log.events().size() > EventLog::most / 2);
  CHECK(log.events().back().tick == 10000);
  log.forget_after(9990);
  CHECK(log.events().back().tick == 9990);
  const auto taken = [&log](const EventFilter& f) {
    return std::ranges::count_if(log.events().end() - 40, log.events().end(),
                                 [&f](const WorldEvent& e) { return f.takes(e); });
  };
  CHECK(taken({}) == 20);
  CHECK(taken({std::nullopt, "", 0}) == 40);
  CHECK(taken({std::nullopt, "crate", 0}) == 10);
  CHECK(taken({WorldEventKind::woke, "", 1e9}) == 20);
  CHECK(taken({WorldEventKind::impact, "", 9.979}) == 6);
}
