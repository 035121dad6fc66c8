// Motors and kinematic bodies that follow courses over time, under both steppers. References:
// closed forms of one degree of freedom, with the error of second order in the tick that going
// straight within it has; the course itself at ticks; the same run from a snapshot and from the
// replay log.
#include "engine/math/rotation.hpp"
#include "engine/math/time_course.hpp"
#include "engine/world/replay.hpp"
#include "tests/support/test_world.hpp"
#include "tests/support/why_not.hpp"

#include <cmath>

using namespace tumble;
using namespace tumble::test;

namespace {

using Course = std::shared_ptr<const TimeCourse>;

Course formula(const char* text) {
  auto made = TimeCourse::expression(text);
  REQUIRE_MESSAGE(made.ok(), test::why_not(made));
  return std::make_shared<const TimeCourse>(*std::move(made));
}
Course table(TimeCourse::Points points) {
  return std::make_shared<const TimeCourse>(*TimeCourse::table(std::move(points)));
}

WorldSettings weightless(const char* stepper, int hz = 60) {
  WorldSettings s;
  s.stepper = stepper;
  s.gravity.setZero();
  s.tick = {hz, 1};
  return s;
}

constexpr double inertia = 0.2;

/// A wheel on a hinge of the world along z with a motor.
struct Wheel : TestWorld {
  BodyId wheel;
  JointId joint;

  Wheel(const WorldSettings& settings, const CoordinateMotor& motor) : TestWorld(settings) {
    BodyDef d = box_def({0, 1, 0}, {0.1, 0.1, 0.1});
    d.mass = 1;
    d.inertia = Vec3(inertia, inertia, inertia);
    wheel = add(d);
    JointDef hinge;
    hinge.kind = JointKind::revolute;
    hinge.b = wheel;
    hinge.frame_a.x = {0, 1, 0};
    hinge.drives[0].motor = motor;
    const auto id = world->create_joint(hinge);
    REQUIRE_MESSAGE(id.ok(), test::why_not(id));
    joint = *id;
    apply();
  }
  CoordinateFrame angle() const {
    const auto frame = world->frame();
    return frame->joints->front().coordinates[0];
  }
};

CoordinateMotor motor(MotorKind kind, Course course, double stiffness = 0, double damping = 0) {
  CoordinateMotor m;
  m.kind = kind;
  m.course = std::move(course);
  m.stiffness = stiffness;
  m.damping = damping;
  return m;
}

BodyDef carried(const Vec3& x, BodyCourse course, const Vec3& half = {0.5, 0.1, 0.5}) {
  BodyDef d = TestWorld::box_def(x, half);
  d.type = BodyType::kinematic;
  d.course = std::make_shared<const BodyCourse>(std::move(course));
  return d;
}

}  // namespace

TEST_CASE("a motor holds a rate that changes") {
  Wheel w(weightless("realtime"), motor(MotorKind::velocity, formula("2*t")));
  w.run(1);
  CHECK(w.angle().rate == doctest::Approx(2).epsilon(1e-9));
  CHECK(w.angle().value == doctest::Approx(1).epsilon(1e-9));
  CHECK(w.angle().motor == doctest::Approx(2 * inertia).epsilon(1e-6));
}

TEST_CASE("a torque that changes: I w = 3 (1 - cos 2t) / 2") {
  for (const char* stepper : {"realtime", "event"}) {
    const auto error = [&](int hz) {
      Wheel w(weightless(stepper, hz), motor(MotorKind::force, formula("3*sin(2*t)")));
      w.run(1);
      return std::fabs(w.angle().rate - 1.5 * (1 - std::cos(2.0)) / inertia);
    };
    const double coarse = error(30), fine = error(60);
    CHECK(fine < 2e-3);
    CHECK(fine == doctest::Approx(coarse / 4).epsilon(0.2));
  }
}

TEST_CASE("a servo follows a sine with the lag of its equation") {
  // I e'' + c e' + k e = I A w^2 sin(w t) for e = angle - A sin(w t), after the start has died out.
  const double A = 0.5, w = 3, k = 60, c = 5;
  const double size = inertia * A * w * w / std::hypot(k - inertia * w * w, c * w);
  const double phase = std::atan2(c * w, k - inertia * w * w);
  for (const char* stepper : {"realtime", "event"}) {
    INFO(stepper);
    Wheel s(weightless(stepper, 120), motor(MotorKind::position, formula("0.5*sin(3*t)"), k, c));
    s.run(4);
    const double expected = A * std::sin(w * 4) + size * std::sin(w * 4 - phase);
    CHECK(std::fabs(s.angle().value - expected) < 2e-4);
  }
}

TEST_CASE("a motor wakes what it begins to move") {
  Wheel w(WorldSettings{}, motor(MotorKind::position, table({{0, 0}, {3, 0}, {4, 1}}), 50, 6));
  w.run(2.5);
  CHECK(w.body(w.wheel).asleep);
  w.run(3.5);
  CHECK(w.angle().value == doctest::Approx(1).epsilon(1e-3));
}

TEST_CASE("a kinematic body is on its course at every tick, and turns as often as it says") {
  for (const char* stepper : {"realtime", "event"}) {
    INFO(stepper);
    TestWorld w(weightless(stepper));
    BodyCourse course;
    course.x = {formula("0.3*cos(2*t)"), nullptr, table({{0, 0}, {1, 2}})};
    course.axis = {0, 3, 0};
    course.angle = formula("40*t^2");
    const BodyId body = w.add(carried({1, 2, 3}, course));
    CHECK(w.body(body).pose.x.x() == doctest::Approx(1.3));
    for (int i = 1; i <= 90; ++i) {
      w.step();
      const double t = i / 60.0;
      CHECK((w.body(body).pose.x - Vec3(1 + 0.3 * std::cos(2 * t), 2, 3 + std::min(2 * t, 2.0)))
                .norm() < 1e-12);
    }
    const Quat turned(axis_angle(Vec3::UnitY(), 40 * 1.5 * 1.5));
    CHECK(w.body(body).pose.q.angularDistance(turned) < 1e-9);
    // What sets its velocity takes it off its course.
    REQUIRE(w->set_velocity(body, {1, 0, 0}, Vec3::Zero()).ok());
    const Vec3 from = w.body(body).pose.x;
    w.run(1);
    CHECK((w.body(body).pose.x - from - Vec3(1, 0, 0)).norm() < 1e-9);
  }
}

TEST_CASE("a lift takes up what lies on it, asleep before it starts") {
  WorldSettings s;
  TestWorld w(s);
  BodyCourse course;
  course.x[1] = table({{0, 0}, {2, 0}, {4, 1}});
  w.add(carried({0, 0.9, 0}, course));
  const BodyId box = w.box({0, 1.1, 0}, {0.1, 0.1, 0.1});
  w.run(1.9);
  CHECK(w.body(box).asleep);
  w.run(3.1);
  CHECK(w.body(box).pose.x.y() == doctest::Approx(2.1).epsilon(2e-3));
}

TEST_CASE("courses go on from a snapshot and from the replay log, bit by bit") {
  const auto make = [] {
    auto w = std::make_unique<Wheel>(weightless("realtime"),
                                     motor(MotorKind::position, formula("sin(5*t)"), 60, 2));
    BodyCourse course;
    course.x[0] = formula("2 + 0.1*sin(t)");
    w->add(carried({0, 1, 0}, course, {0.1, 0.1, 0.1}));
    return w;
  };
  auto w = make();
  w->run(0.7);
  const Bytes saved = (*w)->save();
  w->run(0.7);
  auto other = World::create();
  REQUIRE(other.ok());
  REQUIRE((*other)->load(saved).ok());
  for (int i = 0; i < 42; ++i) REQUIRE((*other)->step().ok());
  CHECK((*other)->state_hash() == (*w)->state_hash());
  const auto replayed = run_replay(save_replay(*w->world));
  REQUIRE(replayed.ok());
  CHECK(replayed->same);
}

TEST_CASE("a course that ends in no number stops the tick and says whose it is") {
  Wheel w(weightless("realtime"), motor(MotorKind::velocity, formula("1/(0.25 - t)")));
  for (int i = 0; i < 14; ++i) w.step();
  const auto failed = w->step();
  REQUIRE_FALSE(failed.ok());
  CHECK(failed.error().text().find("course has no finite value at t = 0.25") != std::string::npos);
}
