// A world of which most sleeps is stepped by what is kept of the sleepers. References: what must be
// so whatever is kept (no contact twice, nothing in anything else), and the same world that is made
// to look at everything in every tick.
#include "tests/support/ring_mesh.hpp"
#include "tests/support/test_world.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include <doctest/doctest.h>

using namespace tumble;
using test::TestWorld;

namespace {

BodyDef platform_def(const Vec3& x) {
  BodyDef def = TestWorld::box_def(x, {2, 0.1, 2});
  def.type = BodyType::kinematic;
  return def;
}

/// Points of contacts between two bodies.
size_t points_between(TestWorld& w, BodyId a, BodyId b) {
  return size_t(std::ranges::count_if(w->frame()->all_contacts(), [&](const ContactFrame& c) {
    return (c.a == a && c.b == b) || (c.a == b && c.b == a);
  }));
}

}  // namespace

TEST_CASE("a platform that starts under a sleeper touches it once") {
  TestWorld w;
  const BodyId platform = w.add(platform_def({0, 1, 0}));
  const BodyId box = w.box({0, 1.6, 0});
  w.run(3);
  REQUIRE(w.body(box).asleep);
  REQUIRE(points_between(w, platform, box) == 4);
  for (const double speed : {0.5, 0.0, -0.5}) {
    REQUIRE(w->set_velocity(platform, {speed, 0, 0}, Vec3::Zero()).ok());
    for (int tick = 0; tick < 120; ++tick) {
      w.step();
      REQUIRE(points_between(w, platform, box) == 4);
    }
  }
}

TEST_CASE("a platform that starts beside sleepers it does not wake is near each of them once") {
  // Reference: the snapshot of the world, which names all that is known of pairs, stays as long.
  TestWorld w;
  w.ground();
  BodyDef wall = platform_def({2.505, 1, 0});
  const BodyId platform = w.add(wall);
  w.box({0, 0.5, 0});
  w.run(3);
  REQUIRE(w->frame()->stats.awake == 0);
  const size_t bytes = w->save(false).size();
  for (int start = 0; start < 8; ++start) {
    for (const double speed : {1e-3, 0.0}) {
      REQUIRE(w->set_velocity(platform, {0, speed, 0}, Vec3::Zero()).ok());
      w.step();
      w.step();
    }
  }
  CHECK(w->save(false).size() < bytes + 100);
}

TEST_CASE("what stands where another stood is looked at though the sleeper beside it knew that") {
  // Reference: a sleeper that is pushed at a wall stops there.
  TestWorld w;
  w.ground();
  BodyDef post = TestWorld::box_def({1.1, 0.5, 0}, {0.565, 0.05, 0.05});
  post.type = BodyType::fixed;
  const BodyId beside = w.add(post);
  const BodyId box = w.box({0, 0.5, 0});
  w.run(3);
  REQUIRE(w.body(box).asleep);
  REQUIRE(w->destroy_body(beside).ok());
  BodyDef wall = TestWorld::box_def({1.1, 0.5, 0}, {0.59, 0.3, 0.3});
  wall.type = BodyType::fixed;
  const BodyId now = w.add(wall);
  REQUIRE(now.index == beside.index);
  REQUIRE(w->set_velocity(box, {1e-3, 0, 0}, Vec3::Zero()).ok());
  w.step();
  CHECK(points_between(w, now, box) == 4);
}

TEST_CASE("what falls asleep and is hit in the next tick by a thin mesh is hit once") {
  // The tick is done in parts, and the sleeper wakes in the first of them. Reference: the same
  // world that looks at everything in every tick.
  struct Shot {
    TestWorld w;
    BodyId box, ring;
    Shot(double from) : w(settings()) {
      w.ground();
      box = w.box({0, 0.5, 0});
      ShapeDef shape;
      shape.type = ShapeType::triangle_mesh;
      shape.mesh = std::make_shared<const TriangleMesh>(ring_mesh(0.3, 0.05, 12, 6));
      BodyDef def = TestWorld::shape_def(shape, {from, 0.5, 0});
      def.velocity = {20, 0, 0};
      def.gravity_scale = 0;
      def.mass = 500;
      ring = w.add(def);
    }
    static WorldSettings settings() {
      WorldSettings s;
      s.broad_phase = "aabb_tree";
      return s;
    }
  };
  Shot miss(1e3);
  int sleep = 0;
  while (!miss.w.body(miss.box).asleep) miss.w.step(), ++sleep;
  int together = 0;
  for (int k = 0; k < 16; ++k) {
    // Its front is at the box some sixteenths of a tick before or after the box is asleep.
    const double from = -0.85 - 20.0 / 60 * (sleep + (k - 4) / 8.0);
    Shot plain(from), thorough(from);
    for (int tick = 0; tick < sleep + 4; ++tick) {
      const bool slept = plain.w.body(plain.box).asleep;
      plain.w.step();
      REQUIRE(thorough.w->set_settings(thorough.w->settings()).ok());
      thorough.w.step();
      together += slept && tick == sleep && !plain.w.body(plain.box).asleep;
      REQUIRE(plain.w->state_hash() == thorough.w->state_hash());
      REQUIRE(plain.w->frame()->stats.contacts == thorough.w->frame()->stats.contacts);
    }
  }
  CHECK(together > 0);
}

TEST_CASE("a lamp that is woken in a later part of a tick bears its weight once") {
  // Its joint is as strong as one and a half times its weight, and the ring that grazes it weighs
  // next to nothing. Reference: gravity acts on it only from where it wakes, so that the mean force
  // of that tick is a part of its weight.
  const double weight = 9.81;
  struct Lamp {
    TestWorld w;
    BodyId lamp, ring;
    Lamp(double from) {
      BodyDef hung = TestWorld::box_def({0, 3, 0});
      hung.mass = 1;
      lamp = w.add(hung);
      JointDef cord;
      cord.kind = JointKind::rigid;
      cord.b = lamp;
      cord.frame_a.x = {0, 3, 0};
      cord.break_force = 1.5 * 9.81;
      REQUIRE(w->create_joint(cord).ok());
      ShapeDef shape;
      shape.type = ShapeType::triangle_mesh;
      shape.mesh = std::make_shared<const TriangleMesh>(ring_mesh(0.3, 0.05, 12, 6));
      BodyDef def = TestWorld::shape_def(shape, {from, 3, 0});
      def.velocity = {20, 0, 0};
      def.gravity_scale = 0;
      def.mass = 1e-4;
      ring = w.add(def);
    }
  };
  Lamp miss(1e3);
  int sleep = 0;
  while (!miss.w.body(miss.lamp).asleep) miss.w.step(), ++sleep;
  sleep += 2;
  int late = 0;
  for (int k = 0; k < 16; ++k) {
    INFO(k);
    Lamp hit(-0.85 - 20.0 / 60 * (sleep + k / 16.0));
    for (int tick = 0; tick < sleep + 4; ++tick) {
      const bool slept = hit.w.body(hit.lamp).asleep;
      hit.w.step();
      const auto frame = hit.w->frame();
      REQUIRE(frame->joints->size() == 1);
      const double force = frame->joints->front().mean_force.norm();
      CHECK(force < 1.01 * weight);
      late += slept && !hit.w.body(hit.lamp).asleep && force < 0.9 * weight;
    }
    CHECK_FALSE(hit.w.body(hit.lamp).asleep);
  }
  CHECK(late > 0);
}

TEST_CASE("sleepers that look around know of each other once") {
  // Reference: bodies that are made asleep far away add as much to the snapshot, which names all
  // that is known of pairs, where two sleepers are near each other as where they are not.
  const auto grown = [](double apart) {
    TestWorld w;
    const auto sleeper = [&w](const Vec3& x) {
      BodyDef def = TestWorld::box_def(x);
      def.starts_asleep = true;
      w.add(def);
      w.step();
      w.step();
      return w->save(false).size();
    };
    sleeper({0, 0.5, 0});
    const size_t two = sleeper({1 + apart, 0.5, 0});
    for (int k = 1; k < 5; ++k) sleeper({100.0 * k, 0, 0});
    return sleeper({500, 0, 0}) - two;
  };
  CHECK(grown(0.035) == grown(2));
}

TEST_CASE("a tick that fails before, while or after something falls asleep or wakes is undone") {
  // What fails is a body that runs out of the numbers there are. Reference: the same world, where
  // it stands still.
  struct Hit {
    TestWorld w;
    BodyId box, far;
    Hit(double velocity) {
      w.ground();
      box = w.box({0, 0.5, 0});
      BodyDef ball = TestWorld::sphere_def({0, 5, 0}, 0.3);
      ball.gravity_scale = 0;
      ball.velocity = {0, -2.5, 0};
      w.add(ball);
      BodyDef def = TestWorld::sphere_def({1.7e308, 1e3, 0});
      def.type = BodyType::kinematic;
      def.velocity = {velocity, 0, 0};
      far = w.add(def);
    }
    bool asleep() { return w.body(box).asleep; }
  };
  Hit undisturbed(0);
  std::vector<int> turns;  // ticks after which the box is no longer as it was
  for (int tick = 1; tick < 240; ++tick) {
    const bool before = undisturbed.asleep();
    undisturbed.w.step();
    if (undisturbed.asleep() != before) turns.push_back(tick);
  }
  REQUIRE(turns.size() >= 2);
  for (const int turn : turns)
    for (int tick = turn - 1; tick < turn + 4; ++tick) {
      CAPTURE(tick);
      Hit fails(0.0976931e308 / (tick - 0.5) * 60), stands(0);
      for (int k = 1; k < tick; ++k) fails.w.step(), stands.w.step();
      REQUIRE_FALSE(fails.w->step().ok());
      REQUIRE_FALSE(fails.w->step().ok());
      for (Hit* hit : {&fails, &stands}) REQUIRE(hit->w->destroy_body(hit->far).ok());
      for (int k = 0; k < 6; ++k) {
        fails.w.step();
        stands.w.step();
        CHECK(fails.w->state_hash() == stands.w->state_hash());
        CHECK(fails.w->frame()->stats.awake == stands.w->frame()->stats.awake);
        CHECK(fails.w->frame()->stats.contact_points == stands.w->frame()->stats.contact_points);
        CHECK(fails.w->frame()->all_contacts().size() == stands.w->frame()->all_contacts().size());
      }
    }
}
