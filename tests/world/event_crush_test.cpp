// What kinematic bodies crush, under the event stepper. References: the moment at which a plate at
// a known speed has used up the room; the text names bodies, cause and cure.
#include "tests/support/test_world.hpp"

#include <cmath>

using namespace tumble;
using test::TestWorld;

namespace {

WorldSettings crush_settings(int hz) {
  WorldSettings s;
  s.tick.num = hz;
  s.stepper = "event";
  s.event.budget = 1000000;  // what is claimed of events is not left to time-stepping
  return s;
}

BodyDef named(BodyDef def, const char* name, BodyType type, double friction) {
  def.name = name;
  def.type = type;
  def.shapes[0].material.friction = friction;
  return def;
}

/// A plate at 1.7 m/s, 0.4 m before a box that stands at a wall.
void add_press(TestWorld& w, double friction) {
  const auto fixed = BodyType::fixed;
  w.add(named(TestWorld::box_def({0, -0.5, 0}, {4, 0.5, 4}), "floor", fixed, friction));
  w.add(named(TestWorld::box_def({1.2, 1, 0}, {0.2, 1, 2}), "wall", fixed, friction));
  BodyDef plate = named(TestWorld::box_def({-0.1, 1.01, 0}, {0.1, 1, 2}), "plate",
                        BodyType::kinematic, friction);
  plate.velocity = {1.7, 0, 0};
  w.add(plate);
  w.add(named(TestWorld::box_def({0.7, 0.3, 0}, {0.3, 0.3, 0.3}), "crate", BodyType::dynamic,
              friction));
}

/// Steps until there is an error, no more than a second.
Error first_error(TestWorld& w) {
  for (int k = 0; k < w->settings().tick.num; ++k) {
    const auto done = w->step();
    if (!done) return done.error();
  }
  FAIL("no error");
  return {};
}

}  // namespace

TEST_CASE("event: what is crushed is named, with what crushes it, when the room is used up") {
  for (const int hz : {60, 240}) {
    for (const double friction : {0.0, 0.4}) {
      TestWorld w(crush_settings(hz));
      add_press(w, friction);
      const Error e = first_error(w);
      CHECK(e.message.find("crushed between body 'wall'") != std::string::npos);
      CHECK(e.message.find("body 'plate'") != std::string::npos);
      CHECK(e.message.find("at 1.7 m/s") != std::string::npos);
      CHECK(e.place.starts_with("tick "));
      CHECK(e.place.find("body 'crate'") != std::string::npos);
      CHECK(e.cure.find("stop the kinematic body") != std::string::npos);
      // The world is where the last whole tick left it.
      CHECK(int(w->tick()) == int(std::floor(0.4 / 1.7 * hz)));
      CHECK(w->frame()->ledger->drift() < 1e-6);
    }
  }
}

TEST_CASE(
    "event: a ball that bounces between a plate and a wall ever faster is crushed in the end") {
  TestWorld w(crush_settings(60));
  const auto fixed = BodyType::fixed;
  w.add(named(TestWorld::box_def({0, -0.5, 0}, {4, 0.5, 4}), "floor", fixed, 0));
  w.add(named(TestWorld::box_def({1.2, 1, 0}, {0.2, 1, 2}), "wall", fixed, 0));
  BodyDef plate =
      named(TestWorld::box_def({-0.1, 1.01, 0}, {0.1, 1, 2}), "plate", BodyType::kinematic, 0);
  plate.velocity = {1.7, 0, 0};
  w.add(plate);
  BodyDef ball = named(TestWorld::sphere_def({0.5, 0.2, 0}, 0.2), "ball", BodyType::dynamic, 0);
  ball.shapes[0].material.restitution = 0.9;
  ball.velocity = {2, 0, 0};
  w.add(ball);
  const Error e = first_error(w);
  CHECK(e.message.find("crushed between body 'wall'") != std::string::npos);
  CHECK(e.place.find("body 'ball'") != std::string::npos);
  CHECK(int(w->tick()) == int(std::floor(0.6 / 1.7 * 60)));
}

TEST_CASE("event: a ball that friction locks between a floor and a plate is said to be jammed") {
  // Above a coefficient of 1 at both; below, it rolls or slides before the plate.
  for (const double friction : {0.8, 1.2}) {
    TestWorld w(crush_settings(240));
    w.add(named(TestWorld::box_def({0, -0.5, 0}, {4, 0.5, 4}), "floor", BodyType::fixed, friction));
    BodyDef plate = named(TestWorld::box_def({-0.6, 1.01, 0}, {0.1, 1, 2}), "plate",
                          BodyType::kinematic, friction);
    plate.velocity = {1.7, 0, 0};
    w.add(plate);
    w.add(named(TestWorld::sphere_def({0, 0.2, 0}, 0.2), "ball", BodyType::dynamic, friction));
    if (friction < 1) {
      w.run(0.6);
      CHECK(w->frame()->body(2).v.x() > 1.4);
      continue;
    }
    const Error e = first_error(w);
    CHECK(e.message.find("jammed between body 'floor'") != std::string::npos);
    CHECK(e.cure.find("less friction") != std::string::npos);
    CHECK(int(w->tick()) == int(std::floor(0.3 / 1.7 * 240)));
  }
}
