// What acts along coordinates of joints, in worlds: breaking, books, new targets by command,
// snapshots, both steppers. References: closed forms, and that the books close.
#include "engine/math/time_course.hpp"
#include "engine/world/world.hpp"
#include "tests/support/why_not.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

BodyDef bar(const Vec3& x) {
  BodyDef d;
  d.pose.x = x;
  d.shapes.emplace_back();
  d.shapes[0].shape.type = ShapeType::box;
  d.shapes[0].shape.half_extents = {0.5, 0.05, 0.05};
  d.mass = 2;
  return d;
}

/// A bar on a hinge at the origin, along z; `offset` is its centre.
struct Hinged {
  std::unique_ptr<World> world;
  BodyId body;
  JointId joint;

  explicit Hinged(const CoordinateDrive& drive, const Vec3& offset = Vec3::Zero(),
                  const std::string& stepper = "realtime", double g = 0) {
    WorldDef def;
    def.settings.gravity = {0, -g, 0};
    def.settings.stepper = stepper;
    auto made = World::create(def);
    REQUIRE(made.ok());
    world = *std::move(made);
    body = *world->create_body(bar(offset));
    JointDef hinge;
    hinge.name = "hinge";
    hinge.kind = JointKind::revolute;
    hinge.b = body;
    hinge.frame_b.x = -offset;
    hinge.drives[0] = drive;
    const auto id = world->create_joint(hinge);
    REQUIRE_MESSAGE(id.ok(), test::why_not(id));
    joint = *id;
    REQUIRE(world->apply_commands().ok());
  }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      const auto done = world->step();
      REQUIRE_MESSAGE(done.ok(), test::why_not(done));
    }
  }
  const CoordinateFrame& angle() const { return frame().coordinates[0]; }
  const JointFrame& frame() const {
    frame_ = world->frame();
    REQUIRE(frame_->joints->size() == 1);
    return frame_->joints->front();
  }
  LedgerEntry line(LedgerLine of) const { return world->frame()->ledger->line(of).total(); }

 private:
  mutable std::shared_ptr<const Frame> frame_;
};

constexpr double inertia = 2 * (1 + 0.01) / 12;

CoordinateDrive spring(double stiffness, double damping, double rest) {
  CoordinateDrive d;
  d.spring = {stiffness, damping, rest};
  return d;
}

}  // namespace

TEST_CASE("both steppers swing a torsion spring alike, and keep its energy") {
  for (const char* stepper : {"realtime", "event"}) {
    Hinged h(spring(4, 0, 0.5), Vec3::Zero(), stepper);
    h.run(90);
    const double omega = std::sqrt(4 / inertia);
    CHECK(std::fabs(h.angle().value - 0.5 + 0.5 * std::cos(omega * 1.5)) < 2e-3);
    const Energies e = h.world->frame()->stats.energies;
    CHECK(e.total() == doctest::Approx(0.5 * 4 * 0.25).epsilon(1e-4));
    CHECK(e.springs == doctest::Approx(2 * std::pow(h.angle().value - 0.5, 2)).epsilon(1e-9));
    CHECK(std::fabs(h.line(LedgerLine::joints).balance) < 1e-4);
  }
}

TEST_CASE("motors of force and of position under the event stepper, with books that close") {
  CoordinateDrive push;
  push.motor.kind = MotorKind::force;
  push.motor.target = 0.3;
  Hinged h(push, Vec3::Zero(), "event");
  h.run(60);
  CHECK(h.angle().rate == doctest::Approx(0.3 / inertia).epsilon(1e-6));
  CHECK(h.angle().motor == doctest::Approx(0.3).epsilon(1e-9));
  CHECK(h.line(LedgerLine::motors).balance ==
        doctest::Approx(0.5 * inertia * std::pow(0.3 / inertia, 2)).epsilon(1e-5));
  CoordinateDrive servo;
  servo.motor = {MotorKind::position, 0.7, 20, 3, no_bound, 0, nullptr};
  Hinged p(servo, Vec3::Zero(), "event");
  p.run(200);
  CHECK(p.angle().value == doctest::Approx(0.7).epsilon(1e-6));
  CHECK(std::fabs(p.line(LedgerLine::integrator).balance) < 1e-4);
}

TEST_CASE("the works of motor, friction and limits are booked by cause") {
  CoordinateDrive d;
  d.motor.kind = MotorKind::force;
  d.motor.target = 0.8;
  d.friction = 0.3;
  d.limits.upper = 1;
  for (const std::string stepper : {"realtime", "event"}) {
    const bool exact = stepper == "event";
    Hinged h(d, Vec3::Zero(), stepper);
    h.run(120);
    CHECK(h.angle().value == doctest::Approx(1).epsilon(exact ? 1e-9 : 1e-6));
    const double close = exact ? 1e-9 : 1e-3;
    CHECK(h.line(LedgerLine::motors).balance == doctest::Approx(0.8).epsilon(close));
    CHECK(h.line(LedgerLine::friction).balance == doctest::Approx(-0.3).epsilon(close));
    CHECK(h.line(LedgerLine::restitution).balance == doctest::Approx(-0.5).epsilon(10 * close));
    CHECK(std::fabs(h.line(LedgerLine::integrator).balance) < 1e-6);
    CHECK(h.angle().motor == doctest::Approx(0.8).epsilon(1e-9));
  }
}

TEST_CASE("event: books of motors that hold a rate, off their axis and with armature") {
  // An arm that is turned evenly against gravity: the motor does the work of lifting it, and gives
  // it, and its rotor, their energy at the beginning.
  for (const double cap : {no_bound, 60.0}) {
    CoordinateDrive d;
    d.motor.kind = MotorKind::velocity;
    d.motor.target = 2;
    d.motor.max_force = cap;
    d.armature = 0.3;
    Hinged h(d, {0.5, 0, 0}, "event", 9.81);
    h.run(30);
    CHECK(h.angle().rate == doctest::Approx(2).epsilon(1e-9));
    const double lifted = 2 * 9.81 * 0.5 * std::sin(h.angle().value);
    const double kinetic = 0.5 * (inertia + 2 * 0.25 + 0.3) * 4;
    CHECK(h.line(LedgerLine::motors).balance == doctest::Approx(lifted + kinetic).epsilon(1e-6));
    CHECK(std::fabs(h.line(LedgerLine::joints).balance) < 1e-5);
    CHECK(std::fabs(h.line(LedgerLine::integrator).balance) < 1e-5);
    CHECK(h.world->frame()->stats.energies.kinetic == doctest::Approx(kinetic).epsilon(1e-9));
    // In the mean of the last tick.
    const double middle = h.angle().value - 2 * 0.5 / 60;
    CHECK(h.angle().motor == doctest::Approx(2 * 9.81 * 0.5 * std::cos(middle)).epsilon(1e-3));
  }
}

TEST_CASE("event: a brake lets go when a growing force is greater, and its works are booked") {
  // F = k t on a bar with friction T: from t0 = T / k on its rate is k (t - t0)^2 / (2 I).
  CoordinateDrive d;
  d.motor.kind = MotorKind::force;
  d.friction = 0.25;
  const double k = 0.9;
  d.motor.course = std::make_shared<TimeCourse>(*TimeCourse::table({{0, 0}, {10, 10 * k}}));
  Hinged h(d, Vec3::Zero(), "event");
  const double start = d.friction / k;
  for (int i = 1; i <= 60; ++i) {
    h.run(1);
    const double t = i / 60.0, since = std::max(0.0, t - start);
    CHECK(std::fabs(h.angle().rate - k * since * since / (2 * inertia)) < 1e-5);
  }
  CHECK(h.line(LedgerLine::friction).balance ==
        doctest::Approx(-d.friction * h.angle().value).epsilon(1e-4));
  CHECK(std::fabs(h.line(LedgerLine::integrator).balance) < 1e-6);
}

TEST_CASE("both steppers agree on what acts along a coordinate as the tick goes to 0") {
  // A pendulum that a brake slows bounces on a stop; then a capped motor takes it away.
  const auto swing = [](const std::string& stepper, int hz) {
    WorldDef def;
    def.settings.stepper = stepper;
    def.settings.tick = TickRate{hz, 1};
    auto world = *World::create(def);
    const BodyId body = *world->create_body(bar({0.5, 0, 0}));
    JointDef hinge;
    hinge.kind = JointKind::revolute;
    hinge.b = body;
    hinge.frame_b.x = {-0.5, 0, 0};
    CoordinateDrive& d = hinge.drives[0];
    d.limits = {-1.2, no_bound, 0, 0, 0.5};
    d.friction = 0.8;
    d.armature = 0.1;
    d.motor.kind = MotorKind::velocity;
    d.motor.target = 0.4;
    d.motor.max_force = 1.5;
    REQUIRE(world->create_joint(hinge).ok());
    for (int i = 0; i < hz; ++i) REQUIRE(world->step().ok());
    return world->frame()->joints->front().coordinates[0].value;
  };
  // By the midpoint rule in steps of a microsecond, with the stop taken as it is passed.
  const double exact = -1.08614;
  CHECK(std::fabs(swing("event", 60) - exact) < 1e-5);
  CHECK(std::fabs(swing("event", 480) - swing("event", 60)) < 1e-6);
  CHECK(std::fabs(swing("realtime", 60) - exact) < 2e-2);
  CHECK(std::fabs(swing("realtime", 960) - exact) < 2e-3);
}

TEST_CASE("armature counts as kinetic energy") {
  CoordinateDrive d;
  d.armature = 0.4;
  d.motor.kind = MotorKind::force;
  d.motor.target = 1;
  for (const char* stepper : {"realtime", "event"}) {
    Hinged h(d, Vec3::Zero(), stepper);
    h.run(60);
    const double rate = 1 / (inertia + 0.4);
    CHECK(h.angle().rate == doctest::Approx(rate).epsilon(1e-6));
    CHECK(h.world->frame()->stats.energies.kinetic ==
          doctest::Approx(0.5 * (inertia + 0.4) * rate * rate).epsilon(1e-6));
    CHECK(std::fabs(h.line(LedgerLine::integrator).balance) < 1e-6);
    CHECK(std::fabs(h.line(LedgerLine::joints).balance) < 1e-9);
  }
}

TEST_CASE("a motor gets a new target by command, keeps its turns, and replays") {
  CoordinateDrive d;
  d.motor.kind = MotorKind::velocity;
  d.motor.target = 10;
  for (const std::string stepper : {"realtime", "event"}) {
    const double close = stepper == "event" ? 1e-5 : 2e-2;
    Hinged h(d, Vec3::Zero(), stepper);
    const Bytes start = h.world->save();
    h.run(60);
    CHECK(h.angle().value == doctest::Approx(10).epsilon(close));
    JointDef def = *h.world->joint(h.joint);
    def.drives[0].motor.target = -5;
    REQUIRE(h.world->set_joint(h.joint, def).ok());
    h.run(60);
    CHECK(h.angle().value == doctest::Approx(5).epsilon(close));
    CHECK(h.angle().rate == doctest::Approx(-5).epsilon(1e-6));
    const auto again = World::create();
    REQUIRE(again.ok());
    REQUIRE((*again)->load(h.world->save()).ok());
    CHECK((*again)->state_hash() == h.world->state_hash());
    h.run(20);
    for (int i = 0; i < 20; ++i) REQUIRE((*again)->step().ok());
    CHECK((*again)->state_hash() == h.world->state_hash());
  }
}

TEST_CASE("event: a snapshot on a limit, held by friction and motor, goes on to the same bits") {
  CoordinateDrive d;
  d.limits.lower = -0.6;
  d.limits.restitution = 0.4;
  d.friction = 0.2;
  d.motor = {MotorKind::velocity, 0.3, 0, 0, 4, 0, nullptr};
  Hinged h(d, {0.5, 0, 0}, "event", 9.81);
  for (int round = 0; round < 12; ++round) {
    h.run(7);
    auto again = *World::create();
    REQUIRE(again->load(h.world->save()).ok());
    h.run(5);
    for (int i = 0; i < 5; ++i) REQUIRE(again->step().ok());
    CHECK(again->state_hash() == h.world->state_hash());
  }
  CHECK(h.angle().value == doctest::Approx(-0.6).epsilon(1e-9));
}

TEST_CASE("event: what no events lead through is time-stepped with its limits and motors") {
  CoordinateDrive d;
  d.limits.lower = -0.5;
  d.motor = {MotorKind::velocity, -3, 0, 0, 2, 0, nullptr};
  Hinged h(d, Vec3::Zero(), "event");
  WorldSettings settings = h.world->settings();
  settings.event.budget = 1;
  REQUIRE(h.world->set_settings(settings).ok());
  h.run(60);
  CHECK(h.angle().value == doctest::Approx(-0.5).epsilon(1e-6));
  CHECK(h.angle().motor == doctest::Approx(-2).epsilon(1e-3));
}

TEST_CASE("event: reactions count what holds along coordinates, certificates balance it") {
  CoordinateDrive d;
  d.limits.lower = -0.4;
  d.friction = 0.5;
  Hinged h(d, {0.5, 0, 0}, "event", 9.81);
  h.run(120);
  REQUIRE(h.angle().value == doctest::Approx(-0.4).epsilon(1e-9));
  const auto reactions = h.world->joint_reactions();
  REQUIRE(reactions.ok());
  const double moment = 2 * 9.81 * 0.5 * std::cos(0.4);
  CHECK(reactions->front().force.y() == doctest::Approx(2 * 9.81).epsilon(1e-9));
  CHECK(reactions->front().torque.z() == doctest::Approx(moment).epsilon(1e-9));
  CHECK(h.frame().mean_torque.z() == doctest::Approx(moment).epsilon(1e-9));
}

TEST_CASE("a joint breaks under its load, is gone then, and says so") {
  for (const char* stepper : {"realtime", "event"}) {
    const double weight = 2 * 9.81;
    for (const double strength : {1.05 * weight, 0.95 * weight}) {
      Hinged h({}, {0, -0.5, 0}, stepper, 9.81);
      JointDef def = *h.world->joint(h.joint);
      def.break_force = strength;
      REQUIRE(h.world->set_joint(h.joint, def).ok());
      h.run(3);
      const auto frame = h.world->frame();
      const bool holds = strength > weight;
      CHECK(frame->stats.joints == (holds ? 1 : 0));
      CHECK(frame->joints->size() == (holds ? 1 : 0));
      CHECK((h.world->joint(h.joint) != nullptr) == holds);
      CHECK(h.world->set_joint(h.joint, def).ok() == holds);
      // Ids stay in step with those that commands reserve.
      JointDef next = def;
      next.break_force = no_bound;
      CHECK(h.world->create_joint(next).ok());
      CHECK(h.world->step().ok());
    }
  }
}

TEST_CASE("a torque breaks a cantilever about its anchor") {
  for (const double strength : {1.05, 0.95}) {
    Hinged h({}, {0.5, 0, 0}, "realtime", 9.81);
    JointDef def = *h.world->joint(h.joint);
    def.kind = JointKind::rigid;
    def.break_torque = strength * 2 * 9.81 * 0.5;
    REQUIRE(h.world->set_joint(h.joint, def).ok());
    h.run(5);
    CHECK(h.world->frame()->stats.joints == (strength > 1 ? 1 : 0));
  }
}

TEST_CASE("reactions of the present moment count what acts along coordinates") {
  for (const char* stepper : {"realtime", "event"}) {
    CoordinateDrive servo;
    servo.motor = {MotorKind::position, 0, 2000, 100, no_bound, 0, nullptr};
    Hinged h(servo, {0.5, 0, 0}, stepper, 9.81);
    h.run(300);
    const auto reactions = h.world->joint_reactions();
    REQUIRE(reactions.ok());
    REQUIRE(reactions->size() == 1);
    CHECK(reactions->front().force.y() == doctest::Approx(2 * 9.81).epsilon(1e-3));
    CHECK(reactions->front().torque.z() == doctest::Approx(2 * 9.81 * 0.5).epsilon(1e-2));
    CHECK(h.angle().motor == doctest::Approx(2 * 9.81 * 0.5).epsilon(1e-2));
    CHECK(h.frame().mean_force.y() == doctest::Approx(2 * 9.81).epsilon(1e-3));
  }
}

TEST_CASE("any number of threads computes the same bits") {
  uint64_t hashes[2];
  for (int i = 0; i < 2; ++i) {
    WorldDef def;
    def.threads = i == 0 ? 1 : 3;
    auto world = *World::create(def);
    BodyId last;
    for (int k = 0; k < 40; ++k) {
      const BodyId body = *world->create_body(bar({0.5 + k, 0, 0}));
      JointDef joint;
      joint.kind = k % 2 ? JointKind::revolute : JointKind::spherical;
      joint.a = last;
      joint.b = body;
      joint.frame_a.x = last.is_null() ? Vec3::Zero() : Vec3(0.5, 0, 0);
      joint.frame_b.x = {-0.5, 0, 0};
      joint.drives[0].friction = 0.2;
      joint.drives[0].limits.upper = 0.5;
      REQUIRE(world->create_joint(joint).ok());
      last = body;
    }
    for (int k = 0; k < 60; ++k) REQUIRE(world->step().ok());
    hashes[i] = world->state_hash();
  }
  CHECK(hashes[0] == hashes[1]);
}
