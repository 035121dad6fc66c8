// Sensors. References: lines through discs over a whole run, worked out in the world's frame and
// not tick by tick; closed forms of bouncing, of weights and of steady streams; worlds of other
// thread counts, loaded from snapshots and replayed, which must say the same bits.
#include "engine/core/random.hpp"
#include "engine/math/rotation.hpp"
#include "engine/world/replay.hpp"
#include "engine/world/sensors/sensor.hpp"
#include "tests/support/test_world.hpp"
#include "tests/support/why_not.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace tumble;
using namespace tumble::test;

namespace {

SensorId sensor(TestWorld& w, const SensorDef& def) {
  const auto id = w->create_sensor(def);
  REQUIRE_MESSAGE(id.ok(), test::why_not(id));
  w.apply();
  return *id;
}

SensorDef gate(SensorShape shape, const Vec3& x = Vec3::Zero(), const Quat& q = Quat::Identity()) {
  SensorDef def;
  def.name = "gate";
  def.shape = shape;
  def.pose = {x, q};
  return def;
}

SensorDef region(SensorShape shape, const Vec3& x = Vec3::Zero()) {
  SensorDef def = gate(shape, x);
  def.kind = SensorKind::region;
  return def;
}

SensorDef contact(BodyId a, BodyId b = {}) {
  SensorDef def;
  def.kind = SensorKind::contact;
  def.a = a;
  def.b = b;
  return def;
}

SensorFrame reading(const World& world, SensorId id) {
  const auto frame = world.frame();
  REQUIRE(frame->sensors);
  for (const SensorFrame& s : *frame->sensors)
    if (s.id == id) return s;
  FAIL("the sensor is not in the frame");
  return {};
}

WorldSettings weightless(const char* stepper = "realtime") {
  WorldSettings s;
  s.gravity = Vec3::Zero();
  s.stepper = stepper;
  return s;
}

/// Turns without favourites that come again with the seed.
Quat any_turn(Random& random) {
  Vec4 q;
  do
    for (int k = 0; k < 4; ++k) q[k] = random.uniform(-1, 1);
  while (q.squaredNorm() > 1 || q.squaredNorm() < 0.01);
  return Quat(q[0], q[1], q[2], q[3]).normalized();
}

Vec3 any_place(Random& random, double reach) {
  return {random.uniform(-reach, reach), random.uniform(-reach, reach),
          random.uniform(-reach, reach)};
}

BodyId flying(TestWorld& w, const Vec3& x, const Vec3& v, double radius = 0.01) {
  BodyDef def = TestWorld::sphere_def(x, radius);
  def.velocity = v;
  def.mass = 2;
  return w.add(def);
}

}  // namespace

TEST_CASE("gates count straight flights as lines through discs have it, whatever the tick") {
  Random random(11);
  int through = 0, total = 0;
  for (const char* stepper : {"realtime", "event"})
    for (int n = 0; n < 40; ++n) {
      TestWorld w(weightless(stepper));
      const Vec3 middle = any_place(random, 1), x = any_place(random, 3);
      const Quat turn = any_turn(random);
      const double radius = random.uniform(0.5, 2), seconds = 0.5;
      // At a point near the disc after about a quarter of a second.
      const Vec3 v = (middle + any_place(random, 1.2) - x) / random.uniform(0.1, 0.5);
      flying(w, x, v);
      const SensorId id = sensor(w, gate({SensorForm::disc, {radius, 0, 0}}, middle, turn));
      w.run(seconds);
      const Vec3 normal = turn * Vec3::UnitY();
      const double t = normal.dot(middle - x) / normal.dot(v);
      const bool hit = t > 0 && t < seconds && (x + t * v - middle).norm() < radius;
      const bool forward = hit && normal.dot(v) > 0;
      const SensorFrame s = reading(*w.world, id);
      CHECK(s.forward == (forward ? 1 : 0));
      CHECK(s.backward == (hit && !forward ? 1 : 0));
      CHECK(s.mass_forward == (forward ? 2.0 : 0.0));
      through += hit;
      ++total;
    }
  CHECK(through > 0.3 * total);
  CHECK(through < 0.7 * total);
}

TEST_CASE(
    "a fast body goes through every gate of a row in one tick, and through the one it ends on") {
  TestWorld w(weightless());
  flying(w, {0, -1, 0}, {0, 60, 0});  // a metre a tick
  std::vector<SensorId> row;
  for (int k = 0; k < 9; ++k)
    row.push_back(sensor(w, gate({SensorForm::rectangle, {1, 0, 1}}, {0, -0.9 + 0.1 * k, 0})));
  const SensorId start = sensor(w, gate({SensorForm::rectangle, {1, 0, 1}}, {0, -1, 0}));
  const SensorId beside = sensor(w, gate({SensorForm::rectangle, {0.1, 0, 1}}, {0.2, -0.5, 0}));
  w.step();
  for (const SensorId id : row) CHECK(reading(*w.world, id).forward == 1);
  CHECK(reading(*w.world, start).forward == 0);  // what is on it is above it
  CHECK(reading(*w.world, beside).forward == 0);
  w.step();
  for (const SensorId id : row) CHECK(reading(*w.world, id).forward == 1);
}

TEST_CASE("neighbouring rectangles count each body once between them") {
  TestWorld w(weightless());
  std::vector<SensorId> row;
  for (int k = 0; k < 4; ++k)
    row.push_back(sensor(w, gate({SensorForm::rectangle, {0.5, 0, 0.5}}, {double(k), 0, 0})));
  for (int k = -2; k <= 14; ++k) flying(w, {0.25 * k, -0.5, 0}, {0, 10, 0}, 0.001);
  w.run(0.2);
  uint64_t sum = 0;
  for (const SensorId id : row) {
    CHECK(reading(*w.world, id).forward == 4);
    sum += reading(*w.world, id).forward;
  }
  CHECK(sum == 16);  // the last one is at the far edge of the last
}

TEST_CASE("a gate counts what its lists name, jumps are no paths") {
  TestWorld w(weightless());
  const BodyId a = flying(w, {0, -1, 0}, {0, 5, 0}), b = flying(w, {0.5, -1, 0}, {0, 5, 0});
  const BodyId jumper = flying(w, {1, -1, 0}, {0, 0, 0});
  SensorDef only = gate({SensorForm::disc, {3, 0, 0}});
  only.only_bodies = {b};
  SensorDef none = gate({SensorForm::disc, {3, 0, 0}});
  none.bodies = false;
  const SensorId all_id = sensor(w, gate({SensorForm::disc, {3, 0, 0}}));
  const SensorId only_id = sensor(w, only), none_id = sensor(w, none);
  REQUIRE(w->set_pose(jumper, {{1, 1, 0}, Quat::Identity()}).ok());
  w.run(0.5);
  CHECK(reading(*w.world, all_id).forward == 2);
  CHECK(reading(*w.world, only_id).forward == 1);
  CHECK(reading(*w.world, none_id).forward == 0);
  REQUIRE(w->set_velocity(a, {0, -5, 0}, Vec3::Zero()).ok());
  w.run(0.5);
  CHECK(reading(*w.world, all_id).backward == 1);
  CHECK(reading(*w.world, only_id).backward == 0);
}

TEST_CASE("a gate on a body sees what it passes itself, and not the body") {
  TestWorld w(weightless());
  BodyDef cart = TestWorld::box_def({-2, 0, 0}, {0.1, 0.1, 0.1});
  cart.type = BodyType::kinematic;
  cart.velocity = {4, 0, 0};
  const BodyId carrier = w.add(cart);
  for (int k = 0; k < 5; ++k) w.sphere({-1 + 0.5 * k, 1, 0}, 0.01);
  SensorDef def =
      gate({SensorForm::disc, {0.2, 0, 0}}, {0, 1, 0}, axis_angle(Vec3::UnitZ(), -M_PI / 2));
  def.carrier = carrier;
  const SensorId id = sensor(w, def);
  w.run(1);
  // Its y axis is the world's x: what stands still goes against it.
  CHECK(reading(*w.world, id).backward == 5);
  CHECK(reading(*w.world, id).forward == 0);
  REQUIRE(w->destroy_body(carrier).ok());
  w.step();
  CHECK(reading(*w.world, id).gone);
  CHECK(reading(*w.world, id).backward == 5);
}

TEST_CASE("the flow of a steady stream is rate times mass, from the nozzle to the drain") {
  for (const char* stepper : {"realtime", "event"}) {
    CAPTURE(stepper);
    TestWorld w(weightless(stepper));
    ParticleSystemDef system;
    system.name = "water";
    system.collide = false;
    system.fast = true;
    const auto water = w->create_particles(system);
    REQUIRE(water.ok());
    EmitterDef jet;
    jet.name = "jet";
    jet.particles = *water;
    jet.rate = 240;
    jet.life = {10};
    jet.speed = {12};  // along y: a fifth of a metre a tick
    jet.mass = {0.05};
    jet.radius = {0.01};
    REQUIRE(w->create_emitter(jet).ok());
    SinkDef sink;
    sink.region = BoxSink{{2, 2, 2}};
    sink.pose.x = {0, 2.01, 0};
    REQUIRE(w->create_sink(sink).ok());
    w.apply();
    SensorDef def = gate({SensorForm::disc, {0.5, 0, 0}}, {0, 0.01, 0});
    def.span = 0.5;
    const SensorId nozzle = sensor(w, def);
    def.pose.x.y() = 0.99;  // less than a tick before the drain
    const SensorId drain = sensor(w, def);
    w.run(1);
    CHECK(reading(*w.world, nozzle).flow == doctest::Approx(12).epsilon(1e-12));
    CHECK(reading(*w.world, drain).flow == doctest::Approx(12).epsilon(1e-12));
    // Number n is born at n / 240 s; it takes y / 12 s to a height of y.
    CHECK(reading(*w.world, nozzle).forward == 239);
    CHECK(reading(*w.world, nozzle).mass_forward == doctest::Approx(239 * 0.05));
    CHECK(reading(*w.world, drain).forward == 220);
    CHECK(reading(*w.world, drain).backward == 0);
  }
}

TEST_CASE("particles that lose or gain mass pass a gate once, and those that have passed no more") {
  for (const double end : {0.5, 2.0}) {
    CAPTURE(end);
    TestWorld w(weightless());
    ParticleSystemDef system;
    system.name = "smoke";
    system.collide = false;
    const auto smoke = w->create_particles(system);
    REQUIRE(smoke.ok());
    EmitterDef puff;
    puff.name = "puff";
    puff.particles = *smoke;
    puff.bursts = {{0, 7, 1, 1}};
    puff.life = {10};
    puff.speed = {1};
    puff.mass = {2};
    puff.mass_over_life = {1, end};
    REQUIRE(w->create_emitter(puff).ok());
    w.apply();
    const SensorId id = sensor(w, gate({SensorForm::disc, {1, 0, 0}}, {0, 0.5, 0}));
    w.run(1);
    const SensorFrame s = reading(*w.world, id);
    CHECK(s.forward == 7);
    CHECK(s.backward == 0);
    // At an age of half a second, within a tick; of its life of 10 s that is a twentieth.
    CHECK(s.mass_forward == doctest::Approx(7 * 2 * (1 + 0.05 * (end - 1))).epsilon(3e-3));
  }
}

TEST_CASE("the flow ends when all that went through has come to rest, though nothing moves") {
  TestWorld w;
  w.ground();
  w.box({0, 1.5, 0}, {0.2, 0.2, 0.2});
  const SensorId id = sensor(w, gate({SensorForm::disc, {1, 0, 0}}, {0, 1, 0}));
  w.run(0.5);
  CHECK(reading(*w.world, id).backward == 1);
  CHECK(reading(*w.world, id).flow < 0);
  w.run(10);
  CHECK(w->frame()->stats.awake == 0);
  CHECK(reading(*w.world, id).flow == 0);
  CHECK(reading(*w.world, id).backward == 1);
}

TEST_CASE("regions hold what is in them: number, mass and names") {
  Random random(5);
  TestWorld w(weightless());
  std::vector<std::pair<BodyId, Vec3>> balls;
  for (int k = 0; k < 200; ++k) {
    const Vec3 x = any_place(random, 2);
    balls.emplace_back(flying(w, x, Vec3::Zero(), 0.001), x);
  }
  ParticleSystemDef dust;
  dust.collide = false;
  for (int k = 0; k < 300; ++k)
    dust.particles.push_back({any_place(random, 2), Vec3::Zero(), 0.5, 0.001});
  REQUIRE(w->create_particles(dust).ok());
  BodyDef wall = TestWorld::sphere_def({0.2, 0, 0}, 0.001);
  wall.type = BodyType::fixed;
  w.add(wall);
  struct Case {
    SensorShape shape;
    bool (*in)(const Vec3&);
  };
  const Case cases[] = {
      {{SensorForm::box, {1, 1.5, 0.8}},
       [](const Vec3& d) {
         return std::fabs(d.x()) < 1 && std::fabs(d.y()) < 1.5 && std::fabs(d.z()) < 0.8;
       }},
      {{SensorForm::sphere, {1.4, 0, 0}}, [](const Vec3& d) { return d.norm() < 1.4; }},
      {{SensorForm::cylinder, {1.2, 1, 0}},
       [](const Vec3& d) { return std::hypot(d.x(), d.z()) < 1.2 && std::fabs(d.y()) < 1; }}};
  const Vec3 middle(0.1, -0.2, 0.3);
  for (const Case& c : cases) {
    const SensorId id = sensor(w, region(c.shape, middle));
    std::vector<BodyId> inside;
    for (const auto& [ball, x] : balls)
      if (c.in(x - middle)) inside.push_back(ball);
    uint64_t particles = 0;
    for (const ParticleDef& p : dust.particles) particles += c.in(p.x - middle);
    const SensorFrame s = reading(*w.world, id);
    CHECK(inside.size() > 10);
    CHECK(inside.size() < 100);
    CHECK(s.inside == inside);
    CHECK(s.particles == particles);
    CHECK(s.mass == doctest::Approx(2.0 * double(inside.size()) + 0.5 * double(particles)));
  }
}

TEST_CASE("a region on a body goes along and turns with it") {
  TestWorld w(weightless());
  BodyDef wheel = TestWorld::box_def({0, 0, 0}, {0.1, 0.1, 0.1});
  wheel.type = BodyType::kinematic;
  wheel.angular_velocity = {0, 0, M_PI};  // half a turn a second
  SensorDef def = region({SensorForm::box, {0.2, 0.2, 0.2}}, {1, 0, 0});
  def.carrier = w.add(wheel);
  const BodyId right = w.sphere({1, 0, 0}, 0.01), left = w.sphere({-1, 0, 0}, 0.01);
  const SensorId id = sensor(w, def);
  CHECK(reading(*w.world, id).inside == std::vector<BodyId>{right});
  w.run(0.5);
  CHECK(reading(*w.world, id).inside.empty());
  w.run(0.5);
  CHECK(reading(*w.world, id).inside == std::vector<BodyId>{left});
}

TEST_CASE("a box on the ground touches once and presses with its weight") {
  for (const char* stepper : {"realtime", "event"}) {
    CAPTURE(stepper);
    WorldSettings settings;
    settings.stepper = stepper;
    TestWorld w(settings);
    const BodyId floor = w.ground();
    BodyDef def = TestWorld::box_def({0, 0.5, 0});
    def.mass = 3;
    const BodyId box = w.add(def), other = w.box({5, 0.5, 0});
    const SensorId any = sensor(w, contact(box)), on_floor = sensor(w, contact(box, floor)),
                   of_floor = sensor(w, contact(floor, box)),
                   never = sensor(w, contact(box, other));
    w.run(2);
    for (const SensorId id : {any, on_floor}) {
      const SensorFrame s = reading(*w.world, id);
      CHECK(s.touching);
      CHECK(s.touches == 1);
      CHECK(s.force.y() == doctest::Approx(3 * 9.81).epsilon(1e-3));
      CHECK(std::hypot(s.force.x(), s.force.z()) < 0.01);
    }
    CHECK(reading(*w.world, of_floor).force.y() == doctest::Approx(-3 * 9.81).epsilon(1e-3));
    CHECK_FALSE(reading(*w.world, never).touching);
    CHECK(reading(*w.world, never).touches == 0);
  }
}

TEST_CASE("a ball touches as often as it bounces, and in the end rests in one touch") {
  for (const char* stepper : {"realtime", "event"}) {
    CAPTURE(stepper);
    WorldSettings settings;
    settings.stepper = stepper;
    TestWorld w(settings);
    w.ground();
    BodyDef def = TestWorld::sphere_def({0, 1.5, 0});
    def.shapes[0].material.restitution = 0.8;
    const BodyId ball = w.add(def);
    const SensorId id = sensor(w, contact(ball));
    // From a height of one metre: at t0, and then 2 e^k t0 later each.
    const double fall = std::sqrt(2 / 9.81);
    double next = fall, flight = 2 * 0.8 * fall;
    uint64_t bounces = 0;
    for (int tick = 1; tick <= 220; ++tick) {
      w.step();
      const double now = w->time();
      while (next < now) {
        ++bounces;
        next += flight;
        flight *= 0.8;
      }
      // A tick on either side of a bounce the two may differ: realtime bounces at ends of ticks.
      const bool clear = next - now > 0.1 && now - (next - flight / 0.8) > 0.1;
      if (clear && bounces < 6) CHECK(reading(*w.world, id).touches == bounces);
      if (clear && bounces < 6) CHECK_FALSE(reading(*w.world, id).touching);
    }
    CHECK(bounces >= 6);
    w.run(8);
    const uint64_t at_rest = reading(*w.world, id).touches;
    CHECK(reading(*w.world, id).touching);
    w.run(5);
    CHECK(reading(*w.world, id).touches == at_rest);
  }
}

namespace {

/// Balls that fall through gates into a box on a moving carrier, with a stream of particles.
struct Lively {
  TestWorld w;
  std::vector<SensorId> ids;

  explicit Lively(const char* stepper, int threads) : w(settings_of(stepper), threads) {
    const BodyId floor = w.ground();
    BodyDef arm = TestWorld::box_def({0, 3, 0}, {0.3, 0.05, 0.3});
    arm.type = BodyType::kinematic;
    arm.angular_velocity = {0, 2, 0.5};
    const BodyId carrier = w.add(arm);
    BodyId first;
    for (int k = 0; k < 27; ++k) {
      const BodyId id = w.sphere({0.5 * (k % 3), 1.4 + 0.5 * (k / 9), 0.5 * (k / 3 % 3)}, 0.15);
      if (k == 0) first = id;
    }
    ParticleSystemDef dust;
    dust.collide = false;
    dust.fast = true;
    for (int k = 0; k < 900; ++k)
      dust.particles.push_back(
          {{0.1 * (k % 30), 1 + 0.05 * (k / 30), 0.3}, Vec3::Zero(), 0.01 * (k + 1)});
    REQUIRE(w->create_particles(dust).ok());
    SensorDef turning = gate({SensorForm::rectangle, {3, 0, 2}}, {0, -1.5, 0});
    turning.carrier = carrier;
    ids = {sensor(w, gate({SensorForm::disc, {3, 0, 0}}, {0, 1, 0})), sensor(w, turning),
           sensor(w, region({SensorForm::cylinder, {1, 1, 0}})), sensor(w, contact(first)),
           sensor(w, contact(floor))};
  }
  static WorldSettings settings_of(const char* stepper) {
    WorldSettings s;
    s.stepper = stepper;
    return s;
  }
};

/// Everything that the sensors say, as numbers.
std::vector<double> all_values(const World& world) {
  std::vector<double> out;
  const auto frame = world.frame();
  REQUIRE(frame->sensors);
  for (const SensorFrame& s : *frame->sensors)
    for (const SensorValue& v : sensor_values(s)) out.push_back(v.value);
  return out;
}

}  // namespace

TEST_CASE(
    "sensors say the same for any number of threads, after snapshots, going back and replay") {
  for (const char* stepper : {"realtime", "event"}) {
    CAPTURE(stepper);
    Lively one(stepper, 1), four(stepper, 4);
    one.w.run(0.3);
    four.w.run(0.3);
    const Bytes snapshot = one.w->save();
    one.w.run(0.4);
    four.w.run(0.4);
    const std::vector<double> expected = all_values(*one.w.world);
    CHECK(reading(*one.w.world, one.ids[0]).backward > 100);
    CHECK(reading(*one.w.world, one.ids[1]).backward > 0);
    CHECK(reading(*one.w.world, one.ids[4]).touches > 0);
    CHECK(all_values(*four.w.world) == expected);

    TestWorld copy;
    REQUIRE(copy->load(snapshot).ok());
    copy.run(0.4);
    CHECK(all_values(*copy.world) == expected);
    TestWorld left, right;  // which begin replay logs of their own
    REQUIRE(left->load(copy->save()).ok());
    REQUIRE(right->load(one.w->save()).ok());
    CHECK(left->save() == right->save());

    const auto replayed = run_replay(save_replay(*one.w.world));
    REQUIRE(replayed.ok());
    CHECK(replayed->same);
    CHECK(all_values(*replayed->world) == expected);

    REQUIRE(one.w->rewind(snapshot).ok());
    one.w.run(0.4);
    CHECK(all_values(*one.w.world) == expected);
  }
}

TEST_CASE("sensors change nothing that moves, and a world without any has none in its frames") {
  Lively with("realtime", 1);
  Lively without("realtime", 1);
  for (const SensorId id : without.ids) REQUIRE(without.w->destroy_sensor(id).ok());
  with.w.run(1);
  without.w.run(1);
  CHECK(with.w->state_hash() == without.w->state_hash());
  CHECK(without.w->frame()->sensors == nullptr);
}

TEST_CASE("sensors that cannot be are refused") {
  TestWorld w;
  const BodyId ball = w.sphere({0, 1, 0});
  CHECK(!w->create_sensor(gate({SensorForm::box, {1, 1, 1}})).ok());
  CHECK(!w->create_sensor(region({SensorForm::disc, {1, 1, 1}})).ok());
  CHECK(!w->create_sensor(gate({SensorForm::disc, {0, 1, 1}})).ok());
  CHECK(!w->create_sensor(contact({}, ball)).ok());
  CHECK(!w->create_sensor(contact(ball, ball)).ok());
  SensorDef def = gate({SensorForm::disc, {1, 0, 0}});
  def.span = 0;
  CHECK(!w->create_sensor(def).ok());
  def.span = 1;
  def.carrier = {77, 1};
  CHECK(!w->create_sensor(def).ok());
  def.carrier = {};
  def.only_systems = {{3, 1}};
  CHECK(!w->create_sensor(def).ok());
  CHECK(!w->destroy_sensor({0, 1}).ok());
  CHECK(w->create_sensor(contact(ball)).ok());
}
