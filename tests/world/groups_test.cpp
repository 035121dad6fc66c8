// Bodies of one group pass through each other, others do not. References: free fall and free
// flight in closed form, symmetry, and equality of bits after a snapshot.
#include "tests/support/test_world.hpp"

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

BodyDef ball(const Vec3& x, const Vec3& v, uint32_t group) {
  BodyDef d =
      TestWorld::shape_def({.type = ShapeType::sphere, .radius = 0.2}, x, BodyType::dynamic);
  d.velocity = v;
  d.group = group;
  d.gravity_scale = 0;
  d.shapes[0].material.restitution = 1;
  return d;
}

WorldSettings settings_of(const char* stepper) {
  WorldSettings s;
  s.stepper = stepper;
  return s;
}

/// Where a ball is after a second that flew at 4 m/s against one at rest, groups as given.
double flown(const char* stepper, uint32_t one, uint32_t other) {
  TestWorld w(settings_of(stepper));
  const BodyId moving = w.add(ball({-2, 0, 0}, {4, 0, 0}, one));
  w.add(ball({0, 0, 0}, Vec3::Zero(), other));
  w.run(1.0);
  return w->body(moving)->pose.x.x();
}

}  // namespace

TEST_CASE("bodies of one group pass through each other, of two groups or none they collide") {
  for (const char* stepper : {"realtime", "event"}) {
    CAPTURE(stepper);
    CHECK(flown(stepper, 3, 3) == doctest::Approx(2).epsilon(1e-9));
    CHECK(flown(stepper, 3, 4) < -0.35);
    CHECK(flown(stepper, 3, 0) < -0.35);
    CHECK(flown(stepper, 0, 0) < -0.35);
  }
}

TEST_CASE("fast bodies of one group are not stopped on the way either") {
  TestWorld w(settings_of("realtime"));
  const BodyId moving = w.add(ball({-2, 0, 0}, {400, 0, 0}, 7));
  w.add(ball({0, 0, 0}, Vec3::Zero(), 7));
  w.run(1.0 / 60);
  CHECK(w->body(moving)->pose.x.x() == doctest::Approx(-2 + 400.0 / 60).epsilon(1e-12));
}

TEST_CASE("bodies of one group do not count as overlapping, and a snapshot knows the group") {
  TestWorld w(settings_of("realtime"));
  const BodyId a = w.add(ball({0, 0, 0}, Vec3::Zero(), 1));
  w.add(ball({0.1, 0, 0}, Vec3::Zero(), 1));
  BodyDef other = ball({0, 0.1, 0}, Vec3::Zero(), 2);
  other.inertia = Vec3(1, 2, 2.5);
  other.products = Vec3(0.1, 0, 0.2);
  other.centre = Vec3(0, 0.3, 0);
  other.drawn.push_back({other.shapes[0].shape, {Vec3(0, 1, 0), Quat::Identity()}, Vec3f(1, 0, 0)});
  const BodyId c = w.add(other);
  REQUIRE(w->apply_commands().ok());
  CHECK(w->overlaps(1e-3).size() == 2);
  TestWorld back(settings_of("realtime"));
  REQUIRE(back->load(w->save()).ok());
  CHECK(back->overlaps(1e-3).size() == 2);
  CHECK(back->body(a)->group == 1);
  CHECK(back->body(c)->inertia_body == w->body(c)->inertia_body);
  REQUIRE(back->body_def(c)->inertia.has_value());
  CHECK(*back->body_def(c)->inertia == Vec3(1, 2, 2.5));
  CHECK(back->body(c)->centre_body == Vec3(0, 0.3, 0));
  const auto drawn = back->frame()->info(c.index).drawn;
  REQUIRE(drawn);
  CHECK((*drawn)[0].part.pose.x == Vec3(0, 0.7, 0));
  CHECK(*(*drawn)[0].colour == Vec3f(1, 0, 0));
}
