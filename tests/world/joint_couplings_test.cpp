// Couplings of joint coordinates (gears, racks, screws, planets) under both steppers. References:
// closed forms of mechanisms of one degree of freedom, whose equation of motion is that of their
// kinetic energy; conserved energy; the same run from a snapshot.
#include "engine/math/rotation.hpp"
#include "tests/support/test_world.hpp"
#include "tests/support/why_not.hpp"

#include <cmath>
#include <numbers>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double g = 9.81;
constexpr std::array steppers{"realtime", "event"};

WorldSettings settings_of(const char* stepper, double gravity = 0) {
  WorldSettings s;
  s.stepper = stepper;
  s.gravity = {0, -gravity, 0};
  return s;
}

/// A box of inertia about z and mass as given, which touches nothing.
BodyDef wheel(const Vec3& x, double mass, double inertia, BodyType type = BodyType::dynamic) {
  BodyDef d = TestWorld::box_def(x, {0.1, 0.1, 0.1});
  d.type = type;
  d.mass = mass;
  d.group = 1;
  d.inertia = Vec3(inertia, inertia, inertia);
  return d;
}

struct Mechanism : TestWorld {
  using TestWorld::TestWorld;

  /// A joint at a place, its main axis along z of the given orientation.
  JointDef def(JointKind kind, BodyId a, BodyId b, const Vec3& at,
               const Quat& q = Quat::Identity()) const {
    JointDef d;
    d.kind = kind;
    d.a = a;
    d.b = b;
    const Pose frame{at, q};
    d.frame_a = a.is_null() ? frame : world->body(a)->body_frame().inverse() * frame;
    d.frame_b = world->body(b)->body_frame().inverse() * frame;
    return d;
  }
  JointId join(const JointDef& d) {
    const auto id = world->create_joint(d);
    REQUIRE_MESSAGE(id.ok(), test::why_not(id));
    apply();
    return *id;
  }
  JointId hinge(BodyId b, const std::optional<CoordinateCouple>& couple = {}, BodyId a = {},
                const CoordinateDrive& drive = {}) {
    JointDef d = def(JointKind::revolute, a, b, body(b).pose.x);
    d.drives[0] = drive;
    d.drives[0].couple = couple;
    return join(d);
  }
  CoordinateFrame of(JointId id, size_t coordinate = 0) const {
    const auto frame = world->frame();
    for (const JointFrame& j : *frame->joints)
      if (j.id == id) return j.coordinates[coordinate];
    FAIL("no such joint");
    return {};
  }
  double energy() const { return world->frame()->stats.energies.total(); }
};

CoordinateDrive pushed(double force) {
  CoordinateDrive d;
  d.motor.kind = MotorKind::force;
  d.motor.target = force;
  return d;
}

/// Turns z up.
Quat upright() {
  return rotation_between(Vec3::UnitZ(), Vec3::UnitY());
}

}  // namespace

TEST_CASE("two wheels in gear turn like one of inertia I1 + I2 / n^2") {
  for (const char* stepper : steppers) {
    for (const double n : {-2.5, 0.04, 60.0}) {
      INFO(stepper << ", " << n);
      Mechanism m(settings_of(stepper));
      const double I1 = 0.02, I2 = 0.3, torque = 0.05;
      const BodyId first = m.add(wheel({0, 1, 0}, 1, I1)), second = m.add(wheel({1, 1, 0}, 3, I2));
      const JointId slow = m.hinge(second);
      const JointId fast = m.hinge(first, CoordinateCouple{slow, 0, n, 0}, {}, pushed(torque));
      m.run(2);
      // Work of the torque: (I1 + I2 / n^2) alpha = torque, and alpha_2 = alpha / n.
      const double alpha = torque / (I1 + I2 / (n * n));
      CHECK(m.of(fast).rate == doctest::Approx(2 * alpha).epsilon(1e-6));
      CHECK(m.of(slow).rate == doctest::Approx(2 * alpha / n).epsilon(1e-6));
      CHECK(m.of(fast).value == doctest::Approx(2 * alpha).epsilon(1e-4));
      CHECK(std::fabs(m.of(fast).value - n * m.of(slow).value) <
            1e-6 * std::max(1.0, std::fabs(n)));
      // What the teeth do: I2 alpha_2 about the second hinge, and its reaction by n on the first.
      const auto reactions = m->joint_reactions();
      REQUIRE(reactions.ok());
      CHECK((*reactions)[0].torque.z() == doctest::Approx(I2 * alpha / n).epsilon(1e-6));
      CHECK((*reactions)[1].torque.z() ==
            doctest::Approx(torque - I2 * alpha / (n * n)).epsilon(1e-6));
      const auto ledger = m->frame()->ledger;
      CHECK(ledger->line(LedgerLine::motors).total().work ==
            doctest::Approx(torque * 2 * alpha).epsilon(1e-3));
      // Hinges lift the wheels' 40 N by what they gave way at the start, less than a micrometre.
      CHECK(std::fabs(ledger->line(LedgerLine::joints).total().work) < 1e-6 * m.energy() + 1e-5);
    }
  }
}

TEST_CASE("a screw falls with g / (1 + I (2 pi / pitch)^2 / m)") {
  for (const char* stepper : steppers) {
    INFO(stepper);
    Mechanism m(settings_of(stepper, g));
    const double mass = 2, inertia = 0.004, lead = 0.05 / (2 * std::numbers::pi);
    const BodyId nut = m.add(wheel({0, 5, 0}, mass, inertia));
    JointDef d = m.def(JointKind::cylindrical, {}, nut, {0, 5, 0}, upright());
    d.drives[0].couple = CoordinateCouple{{}, 1, lead, 0};
    const JointId screw = m.join(d);
    m.run(3);
    const double a = g / (1 + inertia / (mass * lead * lead));
    CHECK(m.body(nut).v.y() == doctest::Approx(-3 * a).epsilon(1e-6));
    CHECK(m.body(nut).pose.x.y() == doctest::Approx(5 - 4.5 * a).epsilon(1e-5));
    // That is more than one turn, and they are counted.
    CHECK(m.of(screw, 1).value < -2 * std::numbers::pi);
    CHECK(m.of(screw, 0).value == doctest::Approx(lead * m.of(screw, 1).value).epsilon(1e-6));
    CHECK(m.energy() == doctest::Approx(mass * g * 5).epsilon(1e-5));
  }
}

TEST_CASE("a rack that falls spins its pinion up: a = g / (1 + I / (m r^2))") {
  for (const char* stepper : steppers) {
    INFO(stepper);
    Mechanism m(settings_of(stepper, g));
    const double radius = 0.2, mass = 1.5, inertia = 0.09;
    const BodyId pinion = m.add(wheel({0, 3, 0}, 4, inertia)),
                 rack = m.add(wheel({radius, 3, 0}, mass, 1));
    const JointId turns = m.hinge(pinion);
    JointDef d = m.def(JointKind::prismatic, {}, rack, {radius, 3, 0}, upright());
    d.drives[0].couple = CoordinateCouple{turns, 0, radius, 0};
    m.join(d);
    m.run(1.5);
    const double a = g / (1 + inertia / (mass * radius * radius));
    CHECK(m.body(rack).v.y() == doctest::Approx(-1.5 * a).epsilon(1e-6));
    CHECK(m.body(pinion).omega.z() == doctest::Approx(-1.5 * a / radius).epsilon(1e-6));
  }
}

TEST_CASE("a planet rolls about a fixed sun, both of its joints on one carrier") {
  for (const char* stepper : steppers) {
    INFO(stepper);
    Mechanism m(settings_of(stepper));
    const double Ic = 0.05, Ip = 0.002, mass = 0.4, R = 0.3, r = 0.1, torque = 0.03;
    const BodyId carrier = m.add(wheel({0, 1, 0}, 1, Ic));
    const BodyId planet = m.add(wheel({R + r, 1, 0}, mass, Ip));
    const JointId arm = m.hinge(carrier, {}, {}, pushed(torque));
    JointDef d = m.def(JointKind::revolute, carrier, planet, {R + r, 1, 0});
    d.drives[0].couple = CoordinateCouple{arm, 0, R / r, 0};
    m.join(d);
    m.run(1.5);
    // T = 1/2 (Ic + m (R + r)^2 + Ip (1 + R/r)^2) w^2.
    const double alpha = torque / (Ic + mass * (R + r) * (R + r) + Ip * (1 + R / r) * (1 + R / r));
    CHECK(m.body(carrier).omega.z() == doctest::Approx(1.5 * alpha).epsilon(1e-5));
    CHECK(m.body(planet).omega.z() == doctest::Approx(1.5 * alpha * (1 + R / r)).epsilon(1e-5));
    CHECK((m.body(planet).pose.x - m.body(carrier).pose.x).norm() ==
          doctest::Approx(R + r).epsilon(1e-7));
  }
}

TEST_CASE("a pendulum in gear with a flywheel keeps its energy and its period of small swings") {
  for (const char* stepper : steppers) {
    INFO(stepper);
    WorldSettings s = settings_of(stepper, g);
    s.event.integrator = "rk4";
    Mechanism m(s);
    const double mass = 1.2, length = 0.5, inertia = 0.02, I2 = 0.01, n = 3;
    const BodyId bob = m.add(wheel({length, 2, 0}, mass, inertia));
    const BodyId fly = m.add(wheel({2, 2, 0}, 1, I2));
    const JointId swing = m.join(m.def(JointKind::revolute, {}, bob, {0, 2, 0}));
    m.hinge(fly, CoordinateCouple{swing, 0, n, 0});
    const double before = m.energy();
    double worst = 0;
    for (int i = 0; i < 10; ++i) {
      m.run(0.5);
      worst = std::max(worst, std::fabs(m.energy() - before));
    }
    // From the horizontal it swings by m g l.
    CHECK(worst < (std::string(stepper) == "event" ? 1e-5 : 2e-3) * mass * g * length);
    const double omega =
        std::sqrt(mass * g * length / (mass * length * length + inertia + n * n * I2));
    // At the lowest point all of it is kinetic: w^2 = 2 omega^2 from the horizontal; never more.
    CHECK(std::fabs(m.of(swing).rate) < std::sqrt(2.0) * omega * (1 + 1e-3));
  }
}

TEST_CASE("a push on one wheel of a gear moves both at once") {
  for (const char* stepper : steppers) {
    INFO(stepper);
    Mechanism m(settings_of(stepper));
    const double I1 = 0.02, I2 = 0.3, n = -3, spin = 7;
    const BodyId first = m.add(wheel({0, 1, 0}, 1, I1)), second = m.add(wheel({1, 1, 0}, 3, I2));
    const JointId slow = m.hinge(second);
    m.hinge(first, CoordinateCouple{slow, 0, n, 0});
    m.run(0.1);
    REQUIRE(m->set_velocity(first, Vec3::Zero(), {0, 0, spin}).ok());
    m.run(0.1);
    // The angular momentum that the teeth pass on, seen from the first wheel.
    const double after = I1 * spin / (I1 + I2 / (n * n));
    CHECK(m.body(first).omega.z() == doctest::Approx(after).epsilon(1e-6));
    CHECK(m.body(second).omega.z() == doctest::Approx(after / n).epsilon(1e-6));
  }
}

TEST_CASE("a kinematic crank drives what is coupled to its joint, awake or asleep") {
  for (const char* stepper : steppers) {
    INFO(stepper);
    Mechanism m(settings_of(stepper));
    const BodyId crank = m.add(wheel({0, 1, 0}, 1, 1, BodyType::kinematic));
    const BodyId driven = m.add(wheel({1, 1, 0}, 1, 0.1));
    const JointId input = m.hinge(crank);
    const JointId output = m.hinge(driven, CoordinateCouple{input, 0, 0.5, 0.25});
    m.run(6);  // closes the offset, under `event` at its recovery_speed, then rests
    CHECK(m.of(output).value == doctest::Approx(0.25).epsilon(1e-6));
    REQUIRE(m->set_velocity(crank, Vec3::Zero(), {0, 0, 4}).ok());
    m.run(5);
    CHECK(m.of(input).value == doctest::Approx(20).epsilon(1e-9));
    CHECK(m.of(output).value == doctest::Approx(10.25).epsilon(1e-6));
    CHECK(m.body(driven).omega.z() == doctest::Approx(2).epsilon(1e-6));
  }
}

TEST_CASE("a gear train with a motor at one end and friction at the other is solved as one") {
  // Five wheels, each three times as fast as the next: the last turns by 1/81 of the first.
  Mechanism m(settings_of("realtime"));
  std::vector<JointId> joints;
  double reflected = 0;
  const double inertia = 0.01, friction = 4;
  for (int i = 0; i < 5; ++i) {
    const BodyId w = m.add(wheel({double(i), 1, 0}, 1, inertia));
    CoordinateDrive drive;
    if (i == 0) drive = pushed(0.2);
    if (i == 4) drive.friction = friction;
    std::optional<CoordinateCouple> couple;
    if (i > 0) couple = CoordinateCouple{joints.back(), 0, -1.0 / 3, 0};
    joints.push_back(m.hinge(w, couple, {}, drive));
    reflected += inertia / std::pow(9.0, i);
  }
  m.run(2);
  const double alpha = (0.2 - friction / 81) / reflected;
  CHECK(m.of(joints[0]).rate == doctest::Approx(2 * alpha).epsilon(1e-9));
  CHECK(m.of(joints[4]).rate == doctest::Approx(m.of(joints[0]).rate / 81).epsilon(1e-6));
}

TEST_CASE("steppers agree on a gear off the centres of mass as the tick goes to 0") {
  const auto angle = [](const char* stepper, int hz) {
    WorldSettings s = settings_of(stepper, g);
    s.tick = {hz, 1};
    Mechanism m(s);
    const BodyId a = m.add(wheel({0.4, 2, 0}, 1, 0.02)), b = m.add(wheel({2, 2.3, 0}, 2, 0.05));
    const JointId first = m.join(m.def(JointKind::revolute, {}, a, {0, 2, 0}));
    JointDef d = m.def(JointKind::revolute, {}, b, {2, 2, 0});
    d.drives[0].couple = CoordinateCouple{first, 0, -1.7, 0};
    m.join(d);
    m.run(1);
    return m.of(first).value;
  };
  const double exact = angle("event", 240);
  const double coarse = std::fabs(angle("realtime", 60) - exact);
  const double fine = std::fabs(angle("realtime", 240) - exact);
  CHECK(fine < 2e-4);
  CHECK(fine < 0.2 * coarse);
}

TEST_CASE("couplings go on from a snapshot, follow commands, and end with either joint") {
  Mechanism m(settings_of("realtime"));
  const BodyId first = m.add(wheel({0, 1, 0}, 1, 0.02)), second = m.add(wheel({1, 1, 0}, 3, 0.3));
  const JointId slow = m.hinge(second);
  const JointId fast = m.hinge(first, CoordinateCouple{slow, 0, 4, 0}, {}, pushed(0.3));
  m.run(0.5);
  const Bytes saved = m->save();
  auto other = World::create();
  REQUIRE(other.ok());
  REQUIRE((*other)->load(saved).ok());
  m.run(0.2);
  for (int i = 0; i < 12; ++i) REQUIRE((*other)->step().ok());
  CHECK((*other)->state_hash() == m->state_hash());
  // Another gear, taken where the wheels are.
  JointDef shifted = *m->joint(fast);
  const double ratio = 1.5;
  shifted.drives[0].couple->ratio = ratio;
  shifted.drives[0].couple->offset = m.of(fast).value - ratio * m.of(slow).value;
  REQUIRE(m->set_joint(fast, shifted).ok());
  m.run(0.2);
  CHECK(m.of(fast).rate == doctest::Approx(ratio * m.of(slow).rate).epsilon(1e-6));
  const double left = m.of(slow).rate;
  REQUIRE(m->destroy_joint(fast).ok());
  m.run(0.2);
  CHECK(m.of(slow).rate == doctest::Approx(left).epsilon(1e-9));
}

TEST_CASE("impossible couplings are refused, and say why") {
  Mechanism m(settings_of("realtime"));
  const BodyId a = m.add(wheel({0, 1, 0}, 1, 1)), b = m.add(wheel({1, 1, 0}, 1, 1));
  const JointId first = m.hinge(a);
  const auto refused = [&](JointKind kind, const CoordinateCouple& couple, const char* why) {
    JointDef d = m.def(kind, {}, b, {1, 1, 0});
    d.drives[0].couple = couple;
    const auto made = m->create_joint(d);
    REQUIRE_FALSE(made.ok());
    CHECK_MESSAGE(made.error().message.find(why) != std::string::npos, made.error().message);
  };
  refused(JointKind::revolute, {{}, 0, 2, 0}, "cannot be coupled to itself");
  refused(JointKind::cylindrical, {{}, 2, 2, 0}, "has only 2");
  refused(JointKind::revolute, {first, 1, 2, 0}, "a revolute joint has only 1");
  refused(JointKind::revolute, {JointId{7, 3}, 0, 2, 0}, "does not exist");
  refused(JointKind::revolute, {first, 0, std::nan(""), 0}, "must be finite");
  refused(JointKind::rigid, {first, 0, 1, 0}, "has only 0");
}
