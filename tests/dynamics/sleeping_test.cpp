// Islands, sleeping and waking. Reference: a flood fill over the contacts for the islands; plain
// expectation for who must be awake.
#include "engine/dynamics/realtime/sleeping.hpp"

#include "engine/dynamics/islands/waking.hpp"
#include "tests/dynamics/piles.hpp"
#include "tests/support/scale.hpp"

#include <deque>

using namespace tumble;
using namespace tumble::test;

TEST_CASE("islands are the connected components over dynamic contacts and links") {
  RigidWorld w;
  w.settings.sleeping = false;
  add_mixed_pile(w, 60);
  w.run(1.5);
  w.links = {{6, 50}, {0, 9}};
  build_islands(w.bodies, w.contacts, w.links, w.h, w.islands);
  std::vector<int> want(w.bodies.size(), 0);
  int count = 0;
  for (uint32_t seed = 0; seed < w.bodies.size(); ++seed) {
    if (!w.bodies[seed].dynamic() || want[seed]) continue;
    want[seed] = ++count;
    std::deque<uint32_t> open{seed};
    const auto visit = [&](uint32_t from, uint32_t to) {
      if (from == open.front() && w.bodies[to].dynamic() && !want[to]) {
        want[to] = count;
        open.push_back(to);
      }
    };
    for (; !open.empty(); open.pop_front()) {
      for (const Contact& c : w.contacts.contacts()) {
        visit(c.key.body_a, c.key.body_b);
        visit(c.key.body_b, c.key.body_a);
      }
      for (const BodyLink& l : w.links) {
        visit(l.a, l.b);
        visit(l.b, l.a);
      }
    }
  }
  REQUIRE(int(w.islands.islands.size()) == count);
  for (uint32_t i = 0; i < w.bodies.size(); ++i) CHECK(int(w.islands.island_of[i]) == want[i]);
  CHECK(w.islands.contacts.size() == w.contacts.size());
}

TEST_CASE("what a force pulls along moves by v = F t / m: sleeping does not hold it back") {
  for (const double acceleration : {0.15, 0.3}) {
    RigidWorld w;
    w.floor(0);
    const uint32_t i = w.add(body(box(0.5, 0.5, 0.5), {0, 0.5, 0}, 0.0));
    w.run(0.2);
    w.before_step = [&] { w.bodies[i].force = {acceleration * w.bodies[i].mass, 0, 0}; };
    w.run(1);
    CHECK(w.bodies[i].v.x() == doctest::Approx(acceleration).epsilon(1e-6));
  }
}

TEST_CASE("a pile of mixed bodies comes to rest and sleeps, whatever the draw, also far out") {
  // At every scale: fewer lie in one layer, and single ones rock for long.
  const int count = 500;
  struct Draw {
    uint64_t seed;
    Vec3 place;  // [m]
  };
  const Draw draws[] = {{3, {0, 0, 0}}, {8, {0, 0, 0}}, {10, {0, 0, 0}}, {3, {1e4, 0, -1e4}}};
  for (int k = 0; k < scaled(4, 1); ++k) {
    const uint64_t seed = draws[k].seed;
    const Vec3& place = draws[k].place;
    CAPTURE(seed);
    CAPTURE(place.x());
    RigidWorld w;
    add_mixed_pile(w, count, seed);
    for (RigidBody& b : w.bodies) b.pose.x += place;
    double slept = -1;
    const int most = test::only_to_run() ? 30 : 60 * 60;
    for (int tick = 0; tick < most && slept < 0; ++tick) {
      w.step();
      if (w.awake() == 0) slept = tick * w.h;
    }
    if (test::only_to_run()) continue;
    REQUIRE(slept > 0);
    MESSAGE("asleep after ", slept, " s");
    CHECK(w.kinetic_energy() == 0);
    const std::vector<RigidBody> rest = w.bodies;
    w.run(1);
    CHECK(w.awake() == 0);
    CHECK(displacement(w, rest) == 0);
    for (const RigidBody& b : w.bodies) {
      if (!b.dynamic()) continue;
      const Vec3 x = b.pose.x - place;
      CHECK(x.y() > 0.1);
      CHECK(std::abs(x.x()) < 4);
      CHECK(std::abs(x.z()) < 4);
    }
  }
}

TEST_CASE("a heap of a thousand boxes sleeps, at the default tick and at shorter ones" *
          doctest::test_suite("long")) {
  for (const double hz : {60.0, 120.0}) {
    RigidWorld w(hz);
    add_walls(w);
    Random r(5);
    for (int i = 0; i < scaled(1000, 200); ++i) {
      const Vec3 x{(i % 8 - 3.5) * 0.9, 1 + 0.9 * (i / 64), (i / 8 % 8 - 3.5) * 0.9};
      w.add(body(box(.3, .3, .3), x + Vec3(r.uniform(-.1, .1), 0, r.uniform(-.1, .1))));
    }
    double slept = -1;
    for (int tick = 0; tick < 60 * hz && slept < 0; ++tick) {
      w.step();
      if (w.awake() == 0) slept = tick * w.h;
    }
    MESSAGE("asleep after ", slept, " s");
    CHECK(slept > 0);
  }
}

TEST_CASE("trembling in place is rest, drifting is not, nor is what swings slowly") {
  // Prescribed velocities, in multiples of that of rest: three to and fro every tick, 1.5 one way,
  // 3 with a period of half a second.
  struct Motion {
    double trembles, drifts, swings;
    bool sleeps;
  };
  for (const Motion& m : {Motion{3, 0, 0, true}, Motion{0, 0.9, 0, true}, Motion{3, 1.5, 0, false},
                          Motion{0, 0, 3, false}}) {
    RigidWorld w;
    w.floor();
    const auto i = w.add(body(box(0.5, 0.5, 0.5), {0, 0.5, 0}));
    w.run(0.1);
    RigidBody& b = w.bodies[i];
    const double resting = w.settings.sleep_speed * std::sqrt(9.81 * b.bounding_radius);
    for (int k = 0; k < 90 && !b.asleep; ++k) {
      const double swing = std::sin(2 * M_PI * k * w.h / 0.5);
      b.v = {resting * ((k % 2 ? 1 : -1) * m.trembles + m.drifts + swing * m.swings), 0, 0};
      b.omega.setZero();
      update_sleeping(w.bodies, w.islands, 9.81, w.h, w.settings, w.sleep_scratch);
    }
    CHECK(b.asleep == m.sleeps);
  }
}

TEST_CASE("what touches a sleeping pile wakes all of it, and only it") {
  RigidWorld w;
  w.floor();
  for (int i = 0; i < 3; ++i) w.add(body(box(0.5, 0.5, 0.5), {0, 0.5 + i, 0}));
  for (int i = 0; i < 3; ++i) w.add(body(box(0.5, 0.5, 0.5), {5, 0.5 + i, 0}));
  w.run(2);
  REQUIRE(w.awake() == 0);
  BodyDef ball = body(sphere(0.2), {0, 5, 0});
  w.add(ball);
  bool pile_woke = false;
  for (int k = 0; k < 90; ++k) {
    w.step();
    pile_woke |= !w.bodies[1].asleep && !w.bodies[3].asleep;
    CHECK(w.bodies[4].asleep);
    if (w.bodies[7].pose.x.y() > 3.5) CHECK(w.bodies[3].asleep);
  }
  CHECK(pile_woke);
}

TEST_CASE("what passes by a sleeper shares its island when something else wakes it") {
  RigidWorld w;
  w.floor();
  const uint32_t sleeper = w.add(body(box(0.5, 0.5, 0.5), {0, 0.5, 0}));
  w.run(2);
  REQUIRE(w.bodies[sleeper].asleep);
  BodyDef passing = body(sphere(0.2), {0.71, 0.2, -0.3});
  passing.velocity = {0, 0, 0.7};
  w.add(passing);
  BodyDef falling = body(sphere(0.2), {0, 2, 0});
  w.add(falling);
  w.settings.speculative_margin = 0.1;
  int woken_with_company = 0;
  for (int k = 0; k < 60; ++k) {
    const bool slept = w.bodies[sleeper].asleep;
    w.step();
    for (const uint32_t i : w.islands.contacts) {
      const ContactKey& key = w.contacts.contacts()[i].key;
      if (!w.bodies[key.body_a].dynamic() || !w.bodies[key.body_b].dynamic()) continue;
      CHECK(w.islands.island_of[key.body_a] == w.islands.island_of[key.body_b]);
      woken_with_company += slept && key.body_a == sleeper && key.body_b == sleeper + 1;
    }
  }
  CHECK(woken_with_company == 1);
}

TEST_CASE("what sleeps is carried with its weight, also while others need ticks in parts") {
  RigidWorld w;
  w.floor();
  const uint32_t i = w.add(body(box(0.5, 0.5, 0.5), {0, 0.5, 0}));
  const auto carried = [&] {
    double sum = 0;
    w.contacts.for_each([&sum](const Contact& c) {
      for (const ContactPoint& p : c.used()) sum += p.normal_impulse;
    });
    return sum;
  };
  const double weight = w.bodies[i].mass * 9.81;
  w.run(2);
  REQUIRE(w.awake() == 0);
  CHECK(carried() == doctest::Approx(weight * w.h).epsilon(1e-3));
  for (int k = 0; k < 100; ++k) w.contacts.scale_impulses(4, w.bodies);
  CHECK(carried() == doctest::Approx(weight * w.h).epsilon(1e-3));
  wake(w.bodies[i]);
  CHECK(w.contacts.rouse(std::span(&i, 1)));
  w.contacts.scale_impulses(4, w.bodies);
  CHECK(carried() == doctest::Approx(4 * weight * w.h).epsilon(1e-3));
}

TEST_CASE("nothing floats when its support is taken away") {
  RigidWorld w;
  w.floor();
  const uint32_t table = w.fixed(box(1, 0.1, 1), {0, 2, 0});
  for (int i = 0; i < 3; ++i) w.add(body(box(0.3, 0.3, 0.3), {0, 2.4 + 0.6 * i, 0}));
  w.run(2);
  REQUIRE(w.awake() == 0);
  wake_touching(w.bodies, w.contacts, table);
  w.contacts.remove_body(table);
  w.bodies[table] = RigidBody{};
  w.bodies[table].type = BodyType::fixed;
  w.run(0.5);
  for (uint32_t i = 2; i < 5; ++i) CHECK(w.bodies[i].pose.x.y() < 2.4 + 0.6 * (i - 2) - 0.5);
}

TEST_CASE("a moving kinematic body wakes what it pushes and keeps it awake") {
  RigidWorld w;
  w.floor();
  const uint32_t i = w.add(body(box(0.5, 0.5, 0.5), {0, 0.5, 0}));
  w.run(2);
  REQUIRE(w.awake() == 0);
  BodyDef d = body(box(0.1, 0.5, 0.5), {-0.8, 0.6, 0});
  d.type = BodyType::kinematic;
  d.velocity = {0.005, 0, 0};  // slower than the threshold of sleep
  w.add(d);
  w.run(60);
  CHECK(w.bodies[i].pose.x.x() == doctest::Approx(-0.8 + 0.3 + 0.6).epsilon(0.05));
}

TEST_CASE("links wake and tie") {
  RigidWorld w;
  w.floor();
  w.add(body(box(0.5, 0.5, 0.5), {0, 0.5, 0}));
  w.add(body(box(0.5, 0.5, 0.5), {5, 0.5, 0}));
  w.links = {{1, 2}};
  w.run(2);
  REQUIRE(w.awake() == 0);
  wake(w.bodies[2]);
  w.step();
  CHECK(!w.bodies[1].asleep);
  CHECK(w.islands.islands.size() == 1);
}

TEST_CASE("a body thrown straight up does not fall asleep at the top") {
  RigidWorld w;
  BodyDef d = body(sphere(2), {0, 0, 0});
  d.velocity = {0, 0.5, 0};
  w.add(d);
  w.run(2);
  CHECK(w.bodies[0].v.y() == doctest::Approx(0.5 - 2 * 9.81).epsilon(1e-9));
}

TEST_CASE("nothing falls asleep in free flight, however large it is or weak its weight") {
  for (const double radius : {1.0, 1e3, 1e5}) {
    for (const double g : {9.81, 1e-3}) {
      RigidWorld w;
      w.gravity = {0, -g, 0};
      BodyDef d = body(sphere(radius), {0, 0, 0});
      d.velocity = {0, 0.25 * g, 0};
      w.add(d);
      w.run(3);
      CHECK(!w.bodies[0].asleep);
      CHECK(w.bodies[0].v.y() == doctest::Approx(-2.75 * g).epsilon(1e-9));
    }
  }
}
