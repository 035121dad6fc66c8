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
#include <numbers>
#include <string>
#include <utility>

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
  s.gravity = Vec3::Zero();
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

namespace {

/// A body that hangs by a joint on one that follows x(t).
struct Carrier : TestWorld {
  BodyId carrier, load;
  JointId joint;

  Carrier(const WorldSettings& settings, Course x, JointDef def, const Vec3& place = Vec3::Zero())
      : TestWorld(settings) {
    BodyCourse course;
    course.x[0] = std::move(x);
    carrier = add(carried(Vec3::Zero(), course, {0.1, 0.1, 0.1}));
    BodyDef d;
    d.mass = 1;
    d.inertia = Vec3(1, 1, 1);
    d.pose.x = place;
    load = add(d);
    def.a = carrier, def.b = load;
    def.frame_b.x = -place;
    const auto id = world->create_joint(def);
    REQUIRE_MESSAGE(id.ok(), test::why_not(id));
    joint = *id;
    apply();
  }
  double work(LedgerLine of) const { return world->frame()->ledger->line(of).total().work; }
};

JointDef of_kind(JointKind kind) {
  JointDef def;
  def.kind = kind;
  return def;
}

/// Angles at t = 1, 2 .. of a pendulum whose pivot goes as A sin(w t): Lagrange's equation
///   (I + m l^2) q'' = -m l (g sin q + x'' cos q) - friction sign(q'), by Runge-Kutta's method with
/// steps of 1e-4 s; the pivot's start is a blow.
std::vector<double> shaken_pendulum(double A, double w, double friction, int seconds) {
  const double m = 1, l = 0.5, whole = 1 + m * l * l, g = 9.81, h = 1e-4;
  double q = 0, u = -m * l * A * w / whole;
  const auto change = [&](double t, double q_now, double u_now) {
    const double pivot = -A * w * w * std::sin(w * t);
    return (-m * l * (g * std::sin(q_now) + pivot * std::cos(q_now)) -
            (u_now > 0 ? friction : -friction)) /
           whole;
  };
  std::vector<double> out;
  for (int i = 0; i < seconds * 10000; ++i) {
    const double t = i * h;
    const double k1 = change(t, q, u), u1 = u;
    const double u2 = u + 0.5 * h * k1, k2 = change(t + 0.5 * h, q + 0.5 * h * u1, u2);
    const double u3 = u + 0.5 * h * k2, k3 = change(t + 0.5 * h, q + 0.5 * h * u2, u3);
    const double u4 = u + h * k3, k4 = change(t + h, q + h * u3, u4);
    q += h / 6 * (u1 + 2 * u2 + 2 * u3 + u4);
    u += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    if ((i + 1) % 10000 == 0) out.push_back(q);
  }
  return out;
}

}  // namespace

TEST_CASE("a joint pulls with the mass times the acceleration of a course, and the course works") {
  for (const char* stepper : {"realtime", "event"}) {
    INFO(stepper);
    Carrier c(weightless(stepper), formula("10*t^2"), of_kind(JointKind::rigid));
    c.run(1);
    const auto reactions = c->joint_reactions();
    REQUIRE_MESSAGE(reactions.ok(), test::why_not(reactions));
    CHECK((reactions->at(0).force - Vec3(20, 0, 0)).norm() < 1e-6);
    const JointFrame mean = c.world->frame()->joints->front();
    CHECK((mean.mean_force - Vec3(20, 0, 0)).norm() < 1e-6);
  }
  // The velocity at the end of a tick is that of the course, and so is the work.
  Carrier along(weightless("event"), formula("10*t^2"), of_kind(JointKind::rigid));
  along.run(1);
  CHECK(along.body(along.load).v.x() == doctest::Approx(20).epsilon(1e-9));
  CHECK(along.work(LedgerLine::kinematic) == doctest::Approx(200).epsilon(1e-9));
  CHECK(std::fabs(along.work(LedgerLine::projection)) < 1e-9);
}

TEST_CASE("a course that accelerates breaks a joint that is too weak for it") {
  for (const char* stepper : {"realtime", "event"})
    for (const double strength : {21.0, 19.0}) {
      INFO(stepper, " ", strength);
      JointDef def = of_kind(JointKind::rigid);
      def.break_force = strength;
      Carrier c(weightless(stepper), formula("10*t^2"), def);
      c.run(1);
      CHECK(c.world->frame()->stats.joints == (strength > 20 ? 1 : 0));
    }
}

TEST_CASE("event: friction of a joint is bounded on a body that shakes") {
  WorldSettings s;
  s.stepper = "event";
  for (const double friction : {0.0, 0.001, 0.05}) {
    INFO(friction);
    JointDef def = of_kind(JointKind::revolute);
    def.drives[0].friction = friction;
    Carrier c(s, formula("0.2*sin(3*t)"), def, {0, -0.5, 0});
    const std::vector<double> expected = shaken_pendulum(0.2, 3, friction, 3);
    for (int second = 0; second < 3; ++second) {
      c.run(1);
      const double angle = c.world->frame()->joints->front().coordinates[0].value;
      CHECK(std::fabs(angle - expected[size_t(second)]) < 2e-4);
    }
  }
}

TEST_CASE("realtime: a pendulum with friction swings on a body that shakes as Lagrange says") {
  // With the body's mean velocity over each tick the errors were 1.5e-5 and 2e-4.
  for (const auto& [friction, bound] : {std::pair{0.001, 2e-6}, std::pair{0.05, 3e-5}}) {
    const double shown_friction = friction;
    CAPTURE(shown_friction);
    JointDef def = of_kind(JointKind::revolute);
    def.drives[0].friction = friction;
    Carrier c(WorldSettings{}, formula("0.2*sin(3*t)"), def, {0, -0.5, 0});
    for (const double expected : shaken_pendulum(0.2, 3, friction, 3)) {
      c.run(1);
      const double angle = c.world->frame()->joints->front().coordinates[0].value;
      CHECK(std::fabs(angle - expected) < bound);
    }
  }
}

TEST_CASE("event: a course that starts at once is a blow, with its impulse and its work") {
  for (const char* x : {"100*t", "100*max(0, t - 0.5)"}) {
    INFO(x);
    JointDef def = of_kind(JointKind::prismatic);
    def.frame_a.q = def.frame_b.q = axis_angle(Vec3::UnitX(), -0.5 * std::numbers::pi);
    Carrier c(weightless("event"), formula(x), def);
    double blow = 0;
    for (int i = 0; i < 60; ++i) {
      c.step();
      blow += c.world->frame()->joints->front().mean_force.x() / 60;
    }
    CHECK(blow == doctest::Approx(100).epsilon(1e-9));
    CHECK(c.body(c.load).v.x() == doctest::Approx(100).epsilon(1e-9));
    // J (v- + v+)/2 of each body: half of what the carrier gives is lost.
    CHECK(c.work(LedgerLine::kinematic) == doctest::Approx(1e4).epsilon(1e-9));
    CHECK(c.work(LedgerLine::joints) == doctest::Approx(-5e3).epsilon(1e-9));
    CHECK(std::fabs(c.work(LedgerLine::projection)) < 1e-6);
  }
}

TEST_CASE("event: a motor of any strength that starts fast loses no turn") {
  for (const double rate : {100.0, 400.0, 5000.0}) {
    INFO(rate);
    CoordinateMotor m;
    m.kind = MotorKind::velocity;
    m.target = rate;
    Wheel w(weightless("event"), m);
    for (int i = 1; i <= 6; ++i) {
      w.step();
      CHECK(w.angle().value == doctest::Approx(rate * i / 60).epsilon(2e-6));
      CHECK(w.angle().rate == doctest::Approx(rate).epsilon(1e-9));
    }
  }
}

TEST_CASE("a body that is changed stays on its course, and one before the first tick begins anew") {
  // Reference: the course itself.
  TestWorld w(weightless("realtime"));
  BodyDef def = TestWorld::box_def({0, 1, 0});
  def.type = BodyType::kinematic;
  def.course = std::make_shared<const BodyCourse>(
      BodyCourse{{formula("1 + sin(2*t)"), nullptr, nullptr}, Vec3::UnitY(), nullptr});
  const BodyId id = w.add(def);
  const auto change = [&](auto what) {
    BodyDef now = *w->body_def(id);
    what(now);
    const Status done = w->set_body(id, now);
    REQUIRE_MESSAGE(done.ok(), test::why_not(done));
    w.apply();
  };
  w.run(0.5);
  change([](BodyDef& d) { d.look.colour = Vec3f(1, 0, 0); });
  CHECK(w->body_def(id)->course == def.course);
  w.run(0.5);
  CHECK(w.body(id).pose.x.x() == doctest::Approx(1 + std::sin(2.0)).epsilon(1e-12));
  CHECK(w.body(id).pose.x.y() == 1);
  // Put elsewhere it leaves its course, and keeps its velocity.
  change([](BodyDef& d) { d.pose.x = Vec3(0, 5, 0); });
  CHECK(w->body_def(id)->course == nullptr);
  w.run(0.25);
  CHECK(w.body(id).pose.x.y() == 5);
}

TEST_CASE(
    "a body that is changed before the first tick starts asleep where its definition says so") {
  const auto made = [](bool asleep) {
    auto w = std::make_unique<TestWorld>();
    w->ground();
    BodyDef def = TestWorld::box_def({0, 3, 0});
    def.starts_asleep = asleep;
    w->add(def);
    return w;
  };
  const auto first = made(true), changed = made(false);
  const auto set_asleep = [&](TestWorld& w, bool asleep) {
    BodyDef def = *w->body_def(w->frame()->body(1).id);
    def.starts_asleep = asleep;
    REQUIRE(w->set_body(w->frame()->body(1).id, def).ok());
    w.apply();
  };
  set_asleep(*changed, true);
  CHECK((*changed)->state_hash() == (*first)->state_hash());
  changed->run(0.5);
  CHECK((*changed)->frame()->body(1).pose.x.y() == 3);  // in the air, as nothing touches it
  // Later it is awake, as what is changed is.
  set_asleep(*changed, true);
  changed->run(0.5);
  CHECK((*changed)->frame()->body(1).pose.x.y() < 2.5);
}

TEST_CASE("a body on a course that is put elsewhere stays turned as it was, and the other way") {
  TestWorld w(weightless("realtime"));
  BodyCourse course;
  course.x[0] = formula("1 + sin(2*t)");
  course.angle = formula("3*t");
  const BodyId id = w.add(carried({0, 1, 0}, course));
  w.run(0.5);
  const Pose then = w.body(id).body_frame();
  const auto set = [&](auto what) {
    BodyDef def = *w->body_def(id);
    what(def);
    REQUIRE(w->set_body(id, def).ok());
    w.apply();
  };
  const Bytes saved = w->save();
  set([](BodyDef& d) { d.pose.x = Vec3(0, 5, 0); });
  CHECK(w.body(id).body_frame().x == Vec3(0, 5, 0));
  CHECK(w.body(id).body_frame().q.angularDistance(then.q) < 1e-12);
  REQUIRE(w->load(saved).ok());
  set([](BodyDef& d) { d.pose.q = Quat(axis_angle(Vec3::UnitX(), 1)); });
  CHECK((w.body(id).body_frame().x - then.x).norm() < 1e-12);
}

TEST_CASE(
    "a sleeping body that a force has woken is awake when it is changed before the first tick") {
  const auto made = [](double mass) {
    auto w = std::make_unique<TestWorld>();
    BodyDef def = TestWorld::box_def({0, 3, 0});
    def.starts_asleep = true;
    def.mass = mass;
    w->add(def);
    QuadraticDragDef wind;
    wind.wind = Vec3(1, 0, 0);
    REQUIRE((*w)->create_force(wind).ok());
    w->apply();
    return w;
  };
  const auto expected = made(2), changed = made(1);
  const BodyId id = (*changed)->frame()->body(0).id;
  BodyDef def = *(*changed)->body_def(id);
  def.mass = 2;
  REQUIRE((*changed)->set_body(id, def).ok());
  changed->apply();
  CHECK_FALSE(changed->body(id).asleep);
  CHECK((*changed)->state_hash() == (*expected)->state_hash());
}
