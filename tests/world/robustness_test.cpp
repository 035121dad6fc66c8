// What a world must bear: any place, any tick, any start, for any time. Realtime stepper, where no
// test says otherwise.
#include "tests/support/scale.hpp"
#include "tests/support/test_world.hpp"

#include <algorithm>
#include <array>
#include <vector>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double wide = 2;  ///< half the width of the bin [m]

/// A floor and four walls about a point.
void add_bin(TestWorld& w, const Vec3& centre) {
  BodyDef floor = TestWorld::box_def(centre + Vec3(0, -0.5, 0), {wide + 1, 0.5, wide + 1});
  floor.type = BodyType::fixed;
  w.add(floor);
  for (const double side : {-1.0, 1.0}) {
    for (const bool x : {true, false}) {
      const double at = side * (wide + 0.5);
      BodyDef wall = TestWorld::box_def(centre + (x ? Vec3(at, 1.5, 0) : Vec3(0, 1.5, at)),
                                        x ? Vec3(0.5, 1.5, wide + 1) : Vec3(wide + 1, 1.5, 0.5));
      wall.type = BodyType::fixed;
      w.add(wall);
    }
  }
}

/// Boxes and balls in turn, in layers of nine.
std::vector<BodyId> add_heap(TestWorld& w, const Vec3& centre, int count) {
  std::vector<BodyId> out;
  for (int i = 0; i < count; ++i) {
    const Vec3 x =
        centre + Vec3(0.9 * (i % 3 - 1), 0.6 + 0.8 * double(i / 9), 0.9 * (i / 3 % 3 - 1));
    out.push_back(i % 2 ? w.sphere(x, 0.3) : w.box(x, {0.35, 0.25, 0.3}));
  }
  return out;
}

struct Sight {
  double fastest = 0, deepest = 0;  ///< [m/s], [m]
  void take(const TestWorld& w, std::span<const BodyId> bodies) {
    for (const BodyId id : bodies) fastest = std::max(fastest, w.body(id).v.norm());
    deepest = std::max(deepest, w.world->frame()->stats.max_penetration);
  }
};

}  // namespace

TEST_CASE("robust: worlds 10 km from the origin are as those at it") {
  // Reference: the same bodies at the origin. Places 10 km off have digits of 2e-12 m, and whether
  // a contact is open by one of these decides if it gives way in a sub-step: the ball's place then
  // differs by micrometres. Single precision would be off by a millimetre.
  const Vec3 far(1e4, -1e4, 1e4);
  TestWorld here, there;
  std::vector<BodyId> bodies;
  for (const auto& [w, centre] : {std::pair{&here, Vec3(0, 0, 0)}, {&there, far}}) {
    add_bin(*w, centre);
    bodies.clear();
    for (int k = 0; k < 6; ++k) bodies.push_back(w->box(centre + Vec3(0, 0.5 + k, 0)));
    BodyDef ball = TestWorld::sphere_def(centre + Vec3(-1.6, 0.3, 0.2), 0.3);
    ball.velocity = {0, 0, 1.5};
    bodies.push_back(w->add(ball));
  }
  for (int tick = 0; tick < 240; ++tick) {
    here.step(), there.step();
    for (const BodyId id : bodies) {
      const RigidBody &a = here.body(id), &b = there.body(id);
      REQUIRE((b.pose.x - far - a.pose.x).norm() < 1e-4);
      REQUIRE((b.v - a.v).norm() < 1e-3);
    }
  }
  CHECK(here->frame()->stats.awake == there->frame()->stats.awake);
}

TEST_CASE("robust: a heap 10 km from the origin comes to rest as heaps at it do") {
  // How a heap falls depends on the last digit of where it starts, so it is compared with what
  // heaps drawn a millimetre apart do at the origin: they rest after 340 to 610 ticks, overlap by
  // 43 to 44 mm on the way and lie with their middle at 0.62 to 0.72 m.
  const int most = test::only_to_run() ? 40 : 900;
  for (const bool far : {false, true}) {
    CAPTURE(far);
    TestWorld w;
    const Vec3 centre = far ? Vec3(-1e4, 1e4, 1e4) : Vec3::Zero();
    add_bin(w, centre);
    const std::vector<BodyId> heap = add_heap(w, centre, 54);
    Sight seen;
    int ticks = 0;
    do {
      w.step();
      seen.take(w, heap);
    } while (++ticks < most && w->frame()->stats.awake > 2);  // a ball may still roll
    if (test::only_to_run()) continue;
    double height = 0;
    for (const BodyId id : heap) height += (w.body(id).pose.x.y() - centre.y()) / 54;
    CHECK(ticks < most);
    CHECK(seen.deepest < 0.05);
    CHECK(seen.fastest < 8);
    CHECK(height > 0.58);
    CHECK(height < 0.78);
  }
}

TEST_CASE("robust: bodies that begin in each other part without being thrown, at any tick") {
  // What is pushed out at push_out_speed (3 m/s) may fall too: it is never faster than by both.
  for (const uint32_t hz : {30u, 60u, 120u, 240u, 1000u}) {
    CAPTURE(hz);
    WorldSettings settings;
    settings.tick = TickRate{hz, 1};
    TestWorld w(settings);
    add_bin(w, Vec3::Zero());
    std::vector<BodyId> bodies;
    for (int i = 0; i < 27; ++i) {  // spaced by 0.6 of their size
      const Vec3 x(0.36 * (i % 3 - 1), 0.3 + 0.36 * double(i / 9), 0.36 * (i / 3 % 3 - 1));
      bodies.push_back(i % 2 ? w.sphere(x, 0.3) : w.box(x, {0.3, 0.3, 0.3}));
    }
    for (int i = 0; i < 2; ++i)
      bodies.push_back(w.box({1.3, 0.3, 1.3}, {0.3, 0.3, 0.3}));  // one place
    Sight seen;
    const uint32_t ticks = test::only_to_run() ? 20 : 5 * hz;
    for (uint32_t tick = 0; tick < ticks; ++tick) {
      w.step();
      seen.take(w, bodies);
    }
    CHECK(seen.fastest < 8);
    if (test::only_to_run()) continue;
    for (const BodyId id : bodies) {
      CHECK(w.body(id).v.norm() < 1);  // a ball may still roll
      CHECK(w.body(id).pose.x.cwiseAbs().maxCoeff() < 3);
    }
    CHECK(w->frame()->stats.max_penetration < 0.01);
  }
}

TEST_CASE("robust: so many in one place that no tick can hold their pairs are refused at once") {
  // Reference: n balls in one place are n (n - 1) / 2 pairs; a tick holds 250,000 and 64 a shape.
  const uint64_t n = 800;
  REQUIRE(n * (n - 1) / 2 > 250'000 + 64 * n);
  for (const char* stepper : {"realtime", "event"}) {
    WorldSettings settings;
    settings.stepper = stepper;
    TestWorld w(settings);
    std::vector<BodyId> bodies;
    for (uint64_t i = 0; i < n; ++i) bodies.push_back(w.sphere({0, 1, 0}, 0.3));
    w.apply();
    const uint64_t before = w->state_hash();
    const auto done = w->step();
    REQUIRE(!done.ok());
    CHECK(done.error().code == ErrorCode::numeric);
    CHECK(done.error().message.find("319600 pairs") != std::string::npos);
    CHECK(done.error().place.find("slot 0") != std::string::npos);
    CHECK(w->state_hash() == before);
  }
}

TEST_CASE("robust: a bin that is stirred for ever stays finite, whole and bounded") {
  // Reference: what the paddle can do. Its tip has 2 m/s; what it hits, and what falls from the
  // height of the bin, is not faster than twice that and the fall.
  TestWorld w;
  add_bin(w, Vec3::Zero());
  BodyDef paddle = TestWorld::box_def({0, 0.4, 0}, {1, 0.3, 0.1});
  paddle.type = BodyType::kinematic;
  paddle.angular_velocity = {0, 2, 0};
  w.add(paddle);
  std::vector<BodyId> bodies;
  for (int i = 0; i < 6; ++i) {
    const Vec3 x(-1.5 + 0.8 * (i % 2), 0.5 + 0.6 * double(i / 2), 1.5);
    bodies.push_back(i % 2 ? w.sphere(x, 0.25) : w.box(x, {0.25, 0.2, 0.3}));
  }
  JointDef pin;  // two that hang together
  pin.a = bodies[0], pin.b = bodies[1];
  pin.frame_a.x = {0.4, 0, 0}, pin.frame_b.x = {-0.4, 0, 0};
  REQUIRE(w->create_joint(pin).ok());
  Sight seen;
  const int ticks = scaled(1000000);
  for (int tick = 0; tick < ticks; ++tick) {
    w.step();
    seen.take(w, bodies);
  }
  CHECK(seen.fastest < 12);
  CHECK(seen.deepest < 0.1);
  for (const BodyId id : bodies) {
    const Vec3 x = w.body(id).pose.x;
    CHECK(std::max(std::fabs(x.x()), std::fabs(x.z())) < wide);
    CHECK(x.y() > 0);
    CHECK(w.body(id).pose.q.norm() == doctest::Approx(1).epsilon(1e-12));
  }
}

TEST_CASE("robust: a body that a kinematic one drags through a fixed wall is named, once") {
  // Reference: the wall of 40 cm is in the way of the crate and of nothing else.
  for (const bool moving : {true, false}) {
    for (const bool wall : {true, false}) {
      CAPTURE(moving);
      CAPTURE(wall);
      std::vector<std::string> said;
      WorldDef def;
      def.threads = 1;
      def.settings.gravity = Vec3::Zero();
      def.log = [&said](LogLevel, std::string_view message) { said.emplace_back(message); };
      const auto w = std::move(*World::create(def));
      BodyDef cart = TestWorld::box_def({0, 2, 0}, {0.2, 0.2, 0.2});
      cart.name = "cart";
      cart.type = BodyType::kinematic;
      if (moving) cart.velocity = {1, 0, 0};
      BodyDef crate = TestWorld::box_def({0, 0, 0}, {0.3, 0.3, 0.3});
      crate.name = "crate";
      BodyDef fixed = TestWorld::box_def({1.2, 0, 0}, {0.2, 1, 1});
      fixed.name = "wall";
      fixed.type = BodyType::fixed;
      JointDef bar;
      bar.kind = JointKind::rigid;
      bar.a = *w->create_body(cart);
      bar.b = *w->create_body(crate);
      bar.frame_b.x = {0, 2, 0};
      if (wall) REQUIRE(w->create_body(fixed).ok());
      REQUIRE(w->create_joint(bar).ok());
      for (int i = 0; i < 180; ++i) REQUIRE(w->step().ok());
      REQUIRE(said.size() == (moving && wall ? 1 : 0));
      for (const std::string& message : said)
        for (const char* name : {"'crate'", "'wall'", "'cart'"})
          CHECK(message.find(name) != std::string::npos);
    }
  }
}
