// Groups in which events crowd, under the event stepper. References: the realtime stepper over the
// same time, whose overlap and energy the ticks that are time-stepped must not exceed; worlds with
// another budget or other bodies, bit by bit, where these make no difference; rigid bodies, which
// do not overlap, by separating axes and nearest points (World::overlaps).
#include "tests/support/test_world.hpp"

#include <algorithm>
#include <cmath>

using namespace tumble;
using test::TestWorld;

namespace {

/// Told once when time-stepping takes over, and by the realtime stepper that it has no integrators.
constexpr const char* told = "said once";

WorldSettings settings(const char* stepper, int budget = EventSettings{}.budget) {
  WorldSettings s;
  s.stepper = stepper;
  s.event.budget = budget;
  return s;
}

/// A column of six blocks, out of which the mouse pulls the third by a corner.
struct Column {
  explicit Column(const WorldSettings& s, bool neighbour = false) : world(s, 1, told) {
    world.ground();
    for (int i = 0; i < blocks; ++i) {
      BodyDef block = TestWorld::box_def({0, 0.15 + 0.3 * i, 0}, {0.3, 0.15, 0.3});
      block.shapes[0].material = {.friction = 0.6, .density = 2400};
      ids[size_t(i)] = world.add(block);
    }
    MouseSpringDef pull;
    pull.anchor.kind = Anchor::Kind::body;
    pull.anchor.body = ids[2];
    pull.anchor.point = {-0.2, 0, 0.3};
    pull.target = {-1.2, 0.75, 0.3};
    pull.frequency = 2;
    pull.damping_ratio = 1;
    pull.max_weights = 10;
    world.force(pull);
    if (neighbour) far = world.box({40, 0.5, 0});
  }
  /// Greatest overlap of any two bodies [m].
  double overlap() const {
    const auto all = world.world->overlaps(0);
    return all.empty() ? 0 : all.front().depth;
  }
  /// Energy that no line of the books explains as coming from outside [J].
  double excess() const {
    const auto frame = world.world->frame();
    return frame->stats.energies.total() -
           std::max(0.0, frame->ledger->line(LedgerLine::user).total().balance);
  }

  static constexpr int blocks = 6;
  TestWorld world;
  BodyId ids[blocks], far;
};

struct Pulled {
  double overlap = 0, excess = 0;  ///< greatest [m], [J] over that of the start
  uint64_t time_stepped = 0, events = 0;
};

Pulled pull(const WorldSettings& s, int ticks) {
  Column c(s);
  Pulled out;
  const double start = c.excess();
  for (int i = 0; i < ticks; ++i) {
    const StepReport report = c.world.step();
    out.time_stepped += report.stats.time_stepped;
    out.events = std::max(out.events, report.stats.events);
    out.overlap = std::max(out.overlap, c.overlap());
    out.excess = std::max(out.excess, c.excess() - start);
  }
  return out;
}

/// A closed room in which boxes are thrown at an ellipsoid that turns more than once in a tick, all
/// of it time-stepped.
struct Throw {
  Throw(double speed, double friction) : world(all_time_stepped(), 1, told) {
    add_walls(2.5);
    ShapeDef flat;
    flat.type = ShapeType::ellipsoid;
    flat.half_extents = {0.53, 0.9, 0.82};
    BodyDef spinner = TestWorld::shape_def(flat, Vec3::Zero());
    spinner.shapes[0].material.density = 7800;
    spinner.angular_velocity = {20, 80, 200};
    world.add(spinner);
    constexpr int count = 12;
    for (int i = 0; i < count; ++i) {
      const double turn = 2 * M_PI * i / count;
      const Vec3 outward(std::cos(turn), 0.3 * (i % 3 - 1), std::sin(turn));
      BodyDef thrown = TestWorld::box_def((1.5 + 0.06 * i) * outward, {half, half, half});
      thrown.velocity = -speed * outward;
      thrown.angular_velocity = {100.0 - 10 * i, 50, 10.0 * i};
      thrown.shapes[0].material.friction = friction;
      thrown.shapes[0].material.density = 7800;
      world.add(thrown);
    }
  }
  /// Greatest overlap at the end of a tick, of the half side of a box [-].
  double deepest(int ticks) {
    double depth = 0;
    for (int i = 0; i < ticks; ++i) {
      CHECK(world.step().stats.time_stepped > 0);
      const auto all = world->overlaps(0);
      if (!all.empty()) depth = std::max(depth, all.front().depth);
    }
    return depth / half;
  }

 private:
  static WorldSettings all_time_stepped() {
    WorldSettings s = settings("event", 1);
    s.gravity = Vec3::Zero();
    s.tick = {30, 1};
    return s;
  }
  void add_walls(double room) {
    constexpr double thickness = 1;
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {-1.0, 1.0}) {
        Vec3 extents = Vec3::Constant(room + 2 * thickness), x = Vec3::Zero();
        extents[axis] = thickness, x[axis] = side * (room + thickness);
        BodyDef wall = TestWorld::box_def(x, extents);
        wall.type = BodyType::fixed;
        wall.shapes[0].material.restitution = 0.9;
        world.add(wall);
      }
  }

  static constexpr double half = 0.15;  // [m]
  TestWorld world;
};

}  // namespace

TEST_CASE("time-stepping: a pulled column is no deeper and gains no more than under realtime" *
          doctest::test_suite("long")) {
  WorldSettings precise = settings("realtime");
  precise.realtime.precise = true;
  const Pulled event = pull(settings("event"), 90), realtime = pull(precise, 90);
  CHECK(event.time_stepped > 0);
  CHECK(event.overlap <= 1.1 * realtime.overlap + 1e-5);
  CHECK(event.excess <= std::max(1.0, 1.1 * realtime.excess));
  CHECK(event.events <= uint64_t(Column::blocks * EventSettings{}.budget));
}

TEST_CASE("time-stepping: its work is in the books by cause") {
  Column c(settings("event", 1));
  uint64_t time_stepped = 0;
  for (int i = 0; i < 60; ++i) time_stepped += c.world.step().stats.time_stepped;
  CHECK(time_stepped > 0);
  const auto frame = c.world->frame();
  CHECK(frame->ledger->line(LedgerLine::friction).total().balance < 0);
  CHECK(frame->ledger->line(LedgerLine::user).total().work > 0);
  // What is left over is the realtime stepper's, which is of first order.
  CHECK(frame->ledger->drift() < 0.01);
}

TEST_CASE("time-stepping: below the budget it makes no difference") {
  const auto bouncing = [](int budget) {
    TestWorld w(settings("event", budget));
    w.ground();
    for (int i = 0; i < 3; ++i) {
      BodyDef ball = TestWorld::sphere_def({0.9 * i, 1.0 + 0.3 * i, 0}, 0.4);
      ball.shapes[0].material.restitution = 0.6;
      w.add(ball);
    }
    w.run(1.5);
    return w->state_hash();
  };
  CHECK(bouncing(EventSettings{}.budget) == bouncing(1000000));
}

TEST_CASE("time-stepping: what is far away does not notice") {
  Column crowd(settings("event", 1), true);
  TestWorld alone(settings("event", 1));
  alone.ground();
  const BodyId box = alone.box({40, 0.5, 0});
  uint64_t time_stepped = 0;
  for (int i = 0; i < 60; ++i) {
    time_stepped += crowd.world.step().stats.time_stepped;
    alone.step();
  }
  CHECK(time_stepped > 0);
  CHECK(crowd.world.body(crowd.far).pose.x == alone.body(box).pose.x);
  CHECK(crowd.world.body(crowd.far).v == alone.body(box).v);
}

TEST_CASE("time-stepping: a snapshot between two of its ticks goes on with the same bits") {
  Column c(settings("event", 1));
  int first = 0;
  while (c.world.step().stats.time_stepped == 0) REQUIRE(++first < 60);
  c.world.step();
  const Bytes kept = c.world->save();
  TestWorld other(settings("event"), 1, told);
  REQUIRE(other->load(kept).ok());
  uint64_t time_stepped = 0;
  for (int i = 0; i < 20; ++i) {
    time_stepped += c.world.step().stats.time_stepped;
    other.step();
    REQUIRE(other->state_hash() == c.world->state_hash());
  }
  CHECK(time_stepped > 0);
}

TEST_CASE("time-stepping: threads do not matter, and others may come to meet its bodies") {
  double deepest = 0;
  const auto thrown = [&deepest](const char* stepper, int threads) {
    WorldSettings s = settings(stepper, 1);
    TestWorld w(s, threads, told);
    w.ground();
    for (int i = 0; i < 4; ++i) w.box({0, 0.15 + 0.3 * i, 0}, {0.3, 0.15, 0.3});
    BodyDef ball = TestWorld::sphere_def({-3, 0.6, 0}, 0.2);
    ball.velocity = {20, 0, 0};
    ball.shapes[0].material.density = 8000;
    w.add(ball);
    w.run(0.5);
    deepest = 0;
    for (const Overlap& o : w->overlaps(0)) deepest = std::max(deepest, o.depth);
    return w->state_hash();
  };
  thrown("realtime", 1);
  const double of_realtime = deepest;
  const uint64_t one = thrown("event", 1), four = thrown("event", 4);
  CHECK(one == four);
  MESSAGE("overlap ", deepest, " m, under realtime ", of_realtime);
  CHECK(deepest <= std::max(of_realtime, 1e-4));
}

TEST_CASE("time-stepping: what spins several times in a tick meets others where it is") {
  double sum = 0;
  int throws = 0;
  for (const double speed : {20.0, 27.0, 35.0, 43.0, 51.0, 60.0})
    for (const double friction : {0.5, 2.0}) sum += Throw(speed, friction).deepest(12), ++throws;
  CHECK(sum / throws <= 0.15);
}
