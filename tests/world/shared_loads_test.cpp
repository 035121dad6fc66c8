// Loads that joints share in more than one way, in statics, under both steppers. References: the
// forces with the least sum of squares in closed form: halves by symmetry, and for parallel rods
// under a rigid table a linear function of the place; where torques take part, what the event
// stepper gives.
#include "engine/math/rotation.hpp"
#include "tests/support/test_world.hpp"
#include "tests/support/why_not.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double g = 9.81;

WorldSettings steady(const std::string& stepper) {
  WorldSettings s;
  s.stepper = stepper;
  s.gravity = {0, -g, 0};
  return s;
}

BodyDef box_at(const Vec3& x, const Vec3& half, double mass) {
  BodyDef d = TestWorld::box_def(x, half);
  d.mass = mass;
  return d;
}

JointId hold(TestWorld& w, JointKind kind, BodyId body, const Vec3& at,
             const Quat& q = Quat::Identity(), double strength = no_bound) {
  JointDef def;
  def.kind = kind;
  def.b = body;
  def.frame_a = {at, q};
  def.frame_b = {at - w.body(body).pose.x, q};
  def.break_force = strength;
  const auto id = w->create_joint(def);
  REQUIRE_MESSAGE(id.ok(), why_not(id));
  return *id;
}

std::vector<JointFrame> loads(const TestWorld& w) {
  return *w.world->frame()->joints;
}

/// A door of 20 kg, a metre wide, on two hinges along y.
struct Door : TestWorld {
  Door(const char* stepper, double strength = no_bound) : TestWorld(steady(stepper)) {
    const BodyId door = add(box_at({0.5, 1, 0}, {0.5, 1, 0.02}, 20));
    const Quat up = axis_angle(Vec3::UnitX(), -0.5 * std::numbers::pi);
    for (const double y : {0.3, 1.7})
      hold(*this, JointKind::revolute, door, {0, y, 0}, up, strength);
    apply();
  }
};

}  // namespace

TEST_CASE("a door hangs on both of its hinges alike") {
  std::array<std::vector<JointFrame>, 2> by;
  for (const size_t i : {0u, 1u}) {
    INFO(i);
    Door w(i == 0 ? "event" : "realtime");
    w.run(0.2);
    by[i] = loads(w);
    REQUIRE(by[i].size() == 2);
    for (const JointFrame& j : by[i])
      CHECK(j.mean_force.y() == doctest::Approx(10 * g).epsilon(1e-6));
    CHECK(std::fabs(by[i][0].mean_force.x() + by[i][1].mean_force.x()) < 1e-6);
  }
  for (const size_t k : {0u, 1u}) {
    CHECK((by[0][k].mean_force - by[1][k].mean_force).norm() < 1e-3 * 20 * g);
    CHECK((by[0][k].mean_torque - by[1][k].mean_torque).norm() < 1e-3 * 20 * g);
  }
}

TEST_CASE("hinges break by their own share of the load") {
  const double largest = [] {
    Door w("event");
    w.run(0.2);
    return std::max(loads(w)[0].mean_force.norm(), loads(w)[1].mean_force.norm());
  }();
  REQUIRE(largest < 0.9 * 20 * g);
  for (const double strength : {1.05, 0.95}) {
    INFO(strength);
    Door w("realtime", strength * largest);
    w.run(0.5);
    CHECK(w->frame()->joints->size() == (strength > 1 ? 2 : 0));
  }
}

TEST_CASE("rods under a table bear what a plane over their feet says") {
  // Least squares under balance of force and of two torques: F = a + b x + c z at (x, z).
  constexpr double mass = 12, x0 = 0.2, z0 = -0.1, load = 8;
  for (const char* stepper : {"event", "realtime"}) {
    INFO(stepper);
    TestWorld w(steady(stepper));
    const BodyId table = w.add(box_at({0, 1, 0}, {1, 0.05, 1}, mass));
    const BodyId weight = w.add(box_at({x0, 1.3, z0}, {0.1, 0.1, 0.1}, load));
    JointDef fixed;
    fixed.kind = JointKind::rigid;
    fixed.a = table;
    fixed.b = weight;
    fixed.frame_a.x = {x0, 0.3, z0};
    REQUIRE(w->create_joint(fixed).ok());
    const auto rod = [&](const Vec3& from, const Vec3& to, double length) {
      JointDef def;
      def.kind = JointKind::distance;
      def.b = table;
      def.frame_a.x = from;
      def.frame_b.x = to;
      def.length = length;
      REQUIRE(w->create_joint(def).ok());
    };
    const std::array<Vec3, 5> feet{Vec3(-0.9, 0, -0.9), Vec3(0.9, 0, -0.9), Vec3(0.9, 0, 0.9),
                                   Vec3(-0.9, 0, 0.9), Vec3(0, 0, 0)};
    for (const Vec3& foot : feet) rod(foot, foot, 1);
    // Rods that lie keep the others upright.
    for (const double z : {-0.9, 0.9}) rod({-3, 1, z}, {-1, 0, z}, 2);
    rod({0, 1, -3}, {0, 0, -1}, 2);
    w.apply();
    w.run(0.2);
    const double a = (mass + load) * g / 5, b = load * g * x0 / (4 * 0.81),
                 c = load * g * z0 / (4 * 0.81);
    const std::vector<JointFrame> found = loads(w);
    REQUIRE(found.size() == 9);
    for (size_t i = 0; i < feet.size(); ++i) {
      const double expected = a + b * feet[i].x() + c * feet[i].z();
      CHECK(found[1 + i].mean_force.y() == doctest::Approx(expected).epsilon(0.02));
    }
  }
}

TEST_CASE("three ropes that hold one weight bear a third each") {
  for (const char* stepper : {"event", "realtime"}) {
    INFO(stepper);
    TestWorld w(steady(stepper));
    const BodyId bob = w.add(box_at({0, 0, 0}, {0.1, 0.1, 0.1}, 3));
    for (int i = 0; i < 3; ++i) hold(w, JointKind::spherical, bob, {0, 0, 0});
    w.apply();
    w.run(0.2);
    for (const JointFrame& j : loads(w))
      CHECK((j.mean_force - Vec3(0, g, 0)).norm() < 1e-6 * 3 * g);
  }
}
