// Emitters and sinks of particles in a world. References: integer arithmetic for counts, closed
// forms of free flight, and worlds of other thread counts, loaded from snapshots and replayed,
// which must have the same bits.
#include "engine/world/replay.hpp"
#include "tests/support/test_world.hpp"
#include "tests/support/why_not.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double h = 1.0 / 60;
constexpr double g = 9.81;

ParticleSystemId system_of(TestWorld& w, bool collide = false, bool fast = true) {
  ParticleSystemDef def;
  def.name = "dust";
  def.collide = collide;
  def.fast = fast;
  const auto id = w->create_particles(def);
  REQUIRE(id.ok());
  w.apply();
  return *id;
}

EmitterId emitter(TestWorld& w, const EmitterDef& def) {
  const auto id = w->create_emitter(def);
  REQUIRE_MESSAGE(id.ok(), test::why_not(id));
  w.apply();
  return *id;
}

EmitterDef jet(ParticleSystemId particles) {
  EmitterDef def;
  def.name = "jet";
  def.particles = particles;
  def.rate = 1000;
  def.life = {2};
  def.speed = {5};
  return def;
}

LedgerEntry total(const TestWorld& w, LedgerLine line) {
  return w.world->frame()->ledger->line(line).total();
}

/// Rockets with trails that burst, rain that splashes on a floor, a jet on a body that turns.
void fill_lively(TestWorld& w) {
  w.ground();
  BodyDef arm = TestWorld::box_def({0, 2, 0}, {0.5, 0.1, 0.1});
  arm.type = BodyType::kinematic;
  arm.angular_velocity = {0, 3, 0};
  const BodyId carrier = w.add(arm);
  const ParticleSystemId dust = system_of(w, true, true);
  EmitterDef spark = jet(dust);
  spark.rate = 0;
  spark.life = {0.4, 0.09, RandomNumber::Kind::normal};
  spark.spread = 3.14;
  spark.size_over_life = {1, 0.5};
  spark.colour_over_life = {Vec3f(1, 1, 1), Vec3f(1, 0, 0)};
  const EmitterId sparks = emitter(w, spark);
  EmitterDef rocket = jet(dust);
  rocket.shape = DiscEmission{2};
  rocket.rate = 7;
  rocket.life = {0.5, 0.1};
  rocket.spread = 0.2;
  rocket.events = {{SpawnRule::On::death, sparks, 20, 0, false},
                   {SpawnRule::On::life, sparks, 1, 30, false},
                   {SpawnRule::On::birth, sparks, 2, 0, false}};
  emitter(w, rocket);
  EmitterDef rain = jet(dust);
  rain.shape = BoxEmission{{4, 0.1, 4}};
  rain.pose.x = {0, 1.5, 0};
  rain.rate = 90;
  rain.speed = {-4, 1};
  rain.events = {{SpawnRule::On::collision, sparks, 3, 0, true}};
  emitter(w, rain);
  EmitterDef hose = jet(dust);
  hose.carrier = carrier;
  hose.pose.x = {0.5, 0, 0};
  hose.rate = 333;
  hose.life = {0.7, 0.2};
  emitter(w, hose);
  SinkDef sink;
  sink.region = SphereSink{1};
  sink.pose.x = {2, 1, 0};
  REQUIRE(w->create_sink(sink).ok());
  w.apply();
}

}  // namespace

TEST_CASE("counts of a world are the whole part of rate times time") {
  for (const char* stepper : {"realtime", "event"}) {
    CAPTURE(stepper);
    WorldSettings settings;
    settings.stepper = stepper;
    TestWorld w(settings);
    EmitterDef def = jet(system_of(w));
    def.rate = 137;
    emitter(w, def);
    for (uint64_t n = 1; n <= 100; ++n) {
      w.step();
      REQUIRE(w->frame()->stats.particles == 137 * n / 60);
    }
  }
}

TEST_CASE("as many live as are born within a life, and the arrays stay where they are") {
  TestWorld w;
  const ParticleSystemId dust = system_of(w);
  EmitterDef def = jet(dust);
  def.rate = 600;
  def.life = {0.5 + 0.4 / 600};
  emitter(w, def);
  w.run(1);
  const ParticleSystem& p = *w->particles(dust);
  const Vec3* place = p.x.data();
  for (int n = 0; n < 120; ++n) {
    w.step();
    CHECK(p.size() == 301);
    CHECK(w->particles(dust)->x.data() == place);
  }
  CHECK(std::ranges::is_sorted(p.id));
}

TEST_CASE("births are spread over the tick: a jet upwards has no gaps") {
  TestWorld w;
  const ParticleSystemId dust = system_of(w);
  EmitterDef def = jet(dust);
  emitter(w, def);
  w.run(0.4);
  const ParticleSystem& p = *w->particles(dust);
  REQUIRE(p.size() == 400);
  for (size_t i = 0; i < p.size(); ++i) {
    const double age = 0.4 - double(i + 1) / 1000;
    CHECK(p.age[i] == doctest::Approx(age).epsilon(1e-9));
    CHECK(p.x[i].y() == doctest::Approx(5 * age - 0.5 * g * age * age).epsilon(1e-9));
    CHECK(p.v[i].y() == doctest::Approx(5 - g * age).epsilon(1e-9));
  }
}

TEST_CASE("particles inherit the velocity of the carrier where they leave it") {
  WorldSettings settings;
  settings.gravity = Vec3::Zero();
  TestWorld w(settings);
  BodyDef arm = TestWorld::box_def({1, 2, 3});
  arm.type = BodyType::kinematic;
  arm.velocity = {2, 0, 0};
  const BodyId id = w.add(arm);
  const ParticleSystemId dust = system_of(w);
  EmitterDef def = jet(dust);
  def.carrier = id;
  def.pose.x = {0, 1, 0};
  def.rate = 300;
  def.speed = {0};
  def.inherit = 0.5;
  emitter(w, def);
  w.run(0.5);
  const ParticleSystem& p = *w->particles(dust);
  REQUIRE(p.size() == 150);
  for (size_t i = 0; i < p.size(); ++i) {
    const double born = double(i + 1) / 300;
    CHECK((p.v[i] - Vec3(1, 0, 0)).norm() < 1e-12);
    CHECK((p.x[i] - Vec3(1 + 2 * born + (0.5 - born), 3, 3)).norm() < 1e-9);
  }
  // One that turns: v + omega x r, at right angles to the arm.
  BodyDef wheel = TestWorld::box_def({0, 0, 9});
  wheel.type = BodyType::kinematic;
  wheel.angular_velocity = {0, 0, 4};
  def.carrier = w.add(wheel);
  def.inherit = 1;
  emitter(w, def);
  const size_t before = w->particles(dust)->size();
  w.step();
  const ParticleSystem& q = *w->particles(dust);
  size_t of_wheel = 0;
  for (size_t i = before; i < q.size(); ++i) {
    if (std::fabs(q.v[i].norm() - 4) > 1e-9) continue;
    ++of_wheel;
    const double ago = q.age[i];
    const Vec3 arm_then = q.x[i] - ago * q.v[i] - Vec3(0, 0, 9);
    CHECK(arm_then.norm() == doctest::Approx(1).epsilon(1e-3));  // the chord of a tick
    CHECK((q.v[i] - Vec3(0, 0, 4).cross(arm_then)).norm() < 0.01);
  }
  CHECK(of_wheel == 5);
}

TEST_CASE("the same bits for any number of threads, after a snapshot and in replay" *
          doctest::test_suite("long")) {
  for (const char* stepper : {"realtime", "event"}) {
    CAPTURE(stepper);
    WorldSettings settings;
    settings.stepper = stepper;
    std::vector<uint64_t> hashes;
    for (const int threads : {1, 2, 4}) {
      TestWorld w(settings, threads);
      fill_lively(w);
      w.run(0.75);
      const Bytes saved = w->save();
      TestWorld later(settings, 1);
      REQUIRE(later->load(saved).ok());
      w.run(0.75);
      later.run(0.75);
      hashes.push_back(w->state_hash());
      CHECK(later->state_hash() == hashes.back());
      CHECK(first_difference(later->save(), w->save()) == "world");  // the length of the log
      if (threads > 1) continue;
      CHECK(w->frame()->stats.particles > 300);
      const auto replayed = run_replay(save_replay(*w.world));
      REQUIRE(replayed.ok());
      CHECK(replayed->same);
    }
    CHECK(hashes[1] == hashes[0]);
    CHECK(hashes[2] == hashes[0]);
  }
}

TEST_CASE("emission and removal are booked: nothing is left to the integrator") {
  TestWorld w;
  fill_lively(w);
  PointGravityDef pull;
  pull.centre = {0, 5, 0};
  pull.mu = 3;
  pull.softening = 0.5;
  w.force(pull);
  w.run(2);
  const auto frame = w->frame();
  CHECK(total(w, LedgerLine::emission).balance > 0);
  CHECK(total(w, LedgerLine::emission).work > 0);
  CHECK(total(w, LedgerLine::removal).work < 0);
  // Momentum has no error of integration: every line is known.
  const double scale = frame->ledger->throughput();
  CHECK(total(w, LedgerLine::integrator).momentum.norm() < 1e-9);
  CHECK(std::fabs(total(w, LedgerLine::integrator).balance) < 2e-3 * scale);
  // Without forces energy is that of what was made, less what went.
  WorldSettings settings;
  settings.gravity = Vec3::Zero();
  TestWorld free(settings);
  EmitterDef def = jet(system_of(free));
  def.life = {0.3, 0.1};
  def.speed = {4, 2};
  def.mass = {0.5, 0.2};
  emitter(free, def);
  free.run(2);
  const double made = total(free, LedgerLine::emission).balance,
               gone = total(free, LedgerLine::removal).balance;
  CHECK(made > 0);
  CHECK(gone < 0);
  CHECK(free->frame()->stats.energies.total() == doctest::Approx(made + gone).epsilon(1e-12));
  CHECK(std::fabs(total(free, LedgerLine::integrator).balance) < 1e-10 * made);
}

TEST_CASE("a rocket bursts where it dies, and its sparks fly on with it") {
  TestWorld w;
  const ParticleSystemId rockets = system_of(w), sparks = system_of(w);
  EmitterDef spark = jet(sparks);
  spark.rate = 0;
  spark.speed = {1};
  spark.spread = 3.14159;
  const EmitterId spark_id = emitter(w, spark);
  EmitterDef rocket = jet(rockets);
  rocket.rate = 0;
  rocket.bursts = {{0.1, 1}};
  rocket.speed = {10};
  rocket.life = {0.507};
  rocket.events = {{SpawnRule::On::death, spark_id, 64, 0, false}};
  emitter(w, rocket);
  w.run(0.6);
  CHECK(w->particles(rockets)->size() == 1);
  CHECK(w->particles(sparks)->size() == 0);
  w.step();
  CHECK(w->particles(rockets)->size() == 0);
  const ParticleSystem& p = *w->particles(sparks);
  REQUIRE(p.size() == 64);
  const double flown = 0.507, since = 37 * h - 0.1 - 0.507;
  const Vec3 burst(0, 10 * flown - 0.5 * g * flown * flown, 0);
  const Vec3 v(0, 10 - g * flown, 0);
  for (size_t i = 0; i < p.size(); ++i) {
    CHECK(p.age[i] == doctest::Approx(since).epsilon(1e-6));
    // Relative to one that goes on falling they have flown in a straight line at 1 m/s.
    const Vec3 falling = burst + since * v - Vec3(0, 0.5 * g * since * since, 0);
    CHECK((p.x[i] - falling).norm() == doctest::Approx(since).epsilon(1e-6));
  }
}

TEST_CASE("what a particle gives birth to while it lives leaves an even trail") {
  WorldSettings settings;
  settings.gravity = Vec3::Zero();
  TestWorld w(settings);
  const ParticleSystemId heads = system_of(w), tail = system_of(w);
  EmitterDef smoke = jet(tail);
  smoke.rate = 0;
  smoke.inherit = 0;
  smoke.speed = {0};
  const EmitterId smoke_id = emitter(w, smoke);
  EmitterDef head = jet(heads);
  head.rate = 0;
  head.bursts = {{0.0123, 1}};
  head.life = {1.001};
  head.events = {{SpawnRule::On::life, smoke_id, 1, 100, false}};
  emitter(w, head);
  w.run(1.2);
  const ParticleSystem& p = *w->particles(tail);
  REQUIRE(p.size() == 100);
  for (size_t i = 0; i < p.size(); ++i)
    CHECK(p.x[i].y() == doctest::Approx(5 * double(i + 1) / 100).epsilon(1e-9));
}

TEST_CASE("a particle gives birth as often as its rate and its life have it, at any tick") {
  WorldSettings settings;
  settings.gravity = Vec3::Zero();
  settings.tick = {240, 1};
  TestWorld w(settings);
  const ParticleSystemId heads = system_of(w), tail = system_of(w);
  EmitterDef smoke = jet(tail);
  smoke.rate = 0;
  smoke.life = {0.1};
  const EmitterId smoke_id = emitter(w, smoke);
  EmitterDef head = jet(heads);
  head.rate = 0;
  head.bursts = {{0, 1}};
  head.life = {10};
  head.events = {{SpawnRule::On::life, smoke_id, 1, 60, false}};
  emitter(w, head);
  for (int n = 1; n <= 2410; ++n) {
    w.step();
    // One in four ticks; those in which births are due may be rounded either way.
    if (n < 2400 && n % 4 == 2) REQUIRE(w->emitter(smoke_id)->made == uint64_t(n / 4));
  }
  CHECK(w->emitter(smoke_id)->made == 600);
}

TEST_CASE("rain dies on the ground and splashes") {
  TestWorld w;
  w.ground();
  const ParticleSystemId drops = system_of(w, true, true), splash = system_of(w, false);
  EmitterDef spray = jet(splash);
  spray.rate = 0;
  spray.inherit = 0;
  const EmitterId spray_id = emitter(w, spray);
  EmitterDef rain = jet(drops);
  rain.pose.x = {0, 1, 0};
  rain.rate = 0;
  rain.bursts = {{0, 10}};
  rain.shape = DiscEmission{1};
  rain.speed = {0};
  rain.events = {{SpawnRule::On::collision, spray_id, 3, 0, true}};
  emitter(w, rain);
  w.run(0.4);
  CHECK(w->particles(drops)->size() == 10);
  w.run(0.2);
  CHECK(w->particles(drops)->size() == 0);
  CHECK(w->particles(splash)->size() == 30);
}

TEST_CASE("sinks take what is in them, of the systems that they name") {
  TestWorld w;
  const ParticleSystemId a = system_of(w), b = system_of(w);
  for (const ParticleSystemId id : {a, b}) {
    EmitterDef def = jet(id);
    def.rate = 60;
    def.speed = {0};
    def.life = {10};
    emitter(w, def);
  }
  SinkDef sink;
  sink.pose.x = {0, -2, 0};
  sink.systems = {b};
  REQUIRE(w->create_sink(sink).ok());
  w.run(2);
  CHECK(w->particles(a)->size() == 120);
  const ParticleSystem& p = *w->particles(b);
  CHECK(std::ranges::all_of(p.x, [](const Vec3& x) { return x.y() >= -2; }));
  const auto falling = size_t(std::sqrt(2 * 2 / g) * 60);
  CHECK(p.size() >= falling);
  CHECK(p.size() <= falling + 1);
}

TEST_CASE("at_most leaves out what would be too many, and life makes room again") {
  TestWorld w;
  const ParticleSystemId dust = system_of(w);
  EmitterDef def = jet(dust);
  def.rate = 60;
  def.at_most = 20;
  def.life = {1};
  emitter(w, def);
  uint64_t last = 0;
  for (int n = 0; n < 300; ++n) {
    w.step();
    CHECK(w->particles(dust)->size() <= 20);
    last = w->particles(dust)->id.back();
  }
  CHECK(last > 90);  // five lives of twenty, less what dies
}

TEST_CASE("particles age and die without emitters, too") {
  TestWorld w;
  ParticleSystemDef def;
  def.fast = true;
  def.collide = false;
  for (int i = 1; i <= 5; ++i) {
    ParticleDef p;
    p.x = {double(i), 0, 0};
    if (i != 3) p.life = 0.1 * i + 0.001;
    def.particles.push_back(p);
  }
  const auto id = w->create_particles(def);
  REQUIRE(id.ok());
  w.run(0.3);
  CHECK(w->particles(*id)->size() == 3);
  w.run(0.5);
  REQUIRE(w->particles(*id)->size() == 1);
  CHECK(w->particles(*id)->x[0].x() == 3);
}

TEST_CASE("size and colour follow the age") {
  TestWorld w;
  const ParticleSystemId dust = system_of(w);
  EmitterDef def = jet(dust);
  def.rate = 0;
  def.bursts = {{0, 1}};
  def.life = {1};
  def.radius = {0.1};
  def.size_over_life = {1, 2};
  def.colour_over_life = {Vec3f(1, 0, 0), Vec3f(0, 1, 0), Vec3f(0, 0, 1)};
  emitter(w, def);
  w.run(0.25);
  const ParticleSystem& p = *w->particles(dust);
  CHECK(p.radius[0] == doctest::Approx(0.125).epsilon(1e-9));
  CHECK((p.colour[0] - Vec3f(0.5f, 0.5f, 0)).norm() < 1e-5f);
  w.run(0.5);
  CHECK(p.radius[0] == doctest::Approx(0.175).epsilon(1e-9));
  CHECK((p.colour[0] - Vec3f(0, 0.5f, 0.5f)).norm() < 1e-5f);
}

TEST_CASE("a world at rest wakes for what is to be emitted later") {
  TestWorld w;
  const ParticleSystemId dust = system_of(w);
  EmitterDef def = jet(dust);
  def.rate = 0;
  def.bursts = {{1, 5}};
  emitter(w, def);
  w.run(0.9);
  CHECK(w->particles(dust)->size() == 0);
  w.run(0.2);
  CHECK(w->particles(dust)->size() == 5);
  w.run(3);
  CHECK(w->particles(dust)->size() == 0);
}

TEST_CASE("more than memory can hold fails the tick, and the world is as before") {
  TestWorld w;
  const ParticleSystemId dust = system_of(w);
  EmitterDef def = jet(dust);
  emitter(w, def);
  w.run(0.1);
  const uint64_t before = w->state_hash();
  def.name = "flood";
  def.rate = 1e12;
  const EmitterId flood = emitter(w, def);
  const auto step = w->step();
  REQUIRE(!step.ok());
  CHECK(step.error().text().find("the emitter 'flood' makes more than 20000000") !=
        std::string::npos);
  CHECK(w->state_hash() == before);
  REQUIRE(w->destroy_emitter(flood).ok());
  w.step();
  CHECK(w->particles(dust)->size() == 116);
}

TEST_CASE("emitters and sinks that name what is not there are refused, and go with their id") {
  TestWorld w;
  const ParticleSystemId dust = system_of(w, true, false);
  EmitterDef def = jet({7, 1});
  CHECK(!w->create_emitter(def).ok());
  def = jet(dust);
  def.carrier = {9, 1};
  CHECK(!w->create_emitter(def).ok());
  def = jet(dust);
  def.events = {{SpawnRule::On::death, {3, 1}, 1, 0, false}};
  CHECK(!w->create_emitter(def).ok());
  def.events = {{SpawnRule::On::collision, {}, 1, 0, true}};  // which nobody looks for
  const auto blind = w->create_emitter(def);
  REQUIRE(!blind.ok());
  CHECK(blind.error().text().find("detect") != std::string::npos);
  SinkDef sink;
  sink.systems = {{7, 1}};
  CHECK(!w->create_sink(sink).ok());
  const EmitterId id = emitter(w, jet(dust));
  w.run(0.1);
  CHECK(w->emitter(id)->made == 100);
  CHECK(w->destroy_emitter(id).ok());
  CHECK(!w->destroy_emitter(id).ok());
  w.run(0.1);
  CHECK(w->emitter(id) == nullptr);
  CHECK(w->particles(dust)->size() == 100);
}

TEST_CASE("mass over life: what is lost leaves with its velocity, and the books have it") {
  TestWorld w;
  const ParticleSystemId dust = system_of(w);
  EmitterDef def = jet(dust);
  def.rate = 0;
  def.bursts = {{0, 10, 1, 1}};
  def.mass = {2};
  def.life = {1};
  def.mass_over_life = {1, 0.25, 0.5};
  emitter(w, def);
  for (int n = 1; n <= 54; ++n) {
    w.step();
    const ParticleSystem& p = *w->particles(dust);
    REQUIRE(p.size() == 10);
    const double u = p.age[0];
    const double factor = u < 0.5 ? 1 - 1.5 * u : 0.25 + 0.5 * (u - 0.5);
    for (size_t i = 0; i < p.size(); ++i) {
      CHECK(p.mass[i] == doctest::Approx(2 * factor));
      CHECK(p.v[i].y() == doctest::Approx(5 - g * u));  // nothing pushes it
    }
  }
  CHECK(std::fabs(w->frame()->ledger->drift()) < 1e-9 * w->frame()->ledger->throughput());
  const double lost = total(w, LedgerLine::removal).momentum.y();
  CHECK(lost < 0);
}

TEST_CASE("grains are born with a spin, and keep it where nothing touches them") {
  TestWorld w;
  ParticleSystemDef grains;
  grains.name = "grains";
  grains.grains.emplace();
  const auto id = w->create_particles(grains);
  REQUIRE(id.ok());
  w.apply();
  EmitterDef def = jet(*id);
  def.rate = 60;
  def.shape = DiscEmission{5};
  def.spin = {30};
  emitter(w, def);
  w.run(0.5);
  const ParticleSystem& p = *w->particles(*id);
  REQUIRE(p.size() == 30);
  Vec3 mean = Vec3::Zero();
  for (const Vec3& spin : p.spin) {
    CHECK(spin.norm() == doctest::Approx(30));
    mean += spin / 30;
  }
  CHECK(mean.norm() < 3 * 30 / std::sqrt(30.0));  // about any axis
}

TEST_CASE("a sink's event has the place at which the particle was taken") {
  TestWorld w;
  const ParticleSystemId dust = system_of(w);
  EmitterDef spark = jet(dust);
  spark.rate = 0;
  spark.speed = {0};
  spark.inherit = 0;
  const EmitterId sparks = emitter(w, spark);
  EmitterDef drop = jet(dust);
  drop.rate = 0;
  drop.speed = {0};
  drop.bursts = {{0, 1, 1, 1}};
  drop.pose.x = {0, 1, 0};
  drop.events = {{SpawnRule::On::sink, sparks, 3, 0, false}};
  const EmitterId drops = emitter(w, drop);
  SinkDef sink;
  sink.region = BoxSink{{1, 0.4, 1}};
  REQUIRE(w->create_sink(sink).ok());
  for (int n = 0; n < 60 && w->emitter(sparks)->made == 0; ++n) w.step();
  CHECK(w->emitter(sparks)->made == 3);
  CHECK(w->emitter(drops)->alive == 0);
  for (const Vec3& x : w->particles(dust)->x) CHECK(std::fabs(x.y()) < 0.2);
}
