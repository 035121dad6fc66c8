// Couplings of coordinates as rows of both solvers. References: closed forms of one degree of
// freedom, whose equation of motion is that of their kinetic energy.
#include "engine/math/rotation.hpp"
#include "tests/dynamics/event_world.hpp"
#include "tests/dynamics/joint_world.hpp"

#include <memory>
#include <numbers>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double g = 9.81;

uint32_t wheel(BodyList& w, const Vec3& x, double mass, double inertia) {
  BodyDef d = body(box(0.05, 0.05, 0.05), x);
  d.mass = mass;
  d.inertia = Vec3(inertia, inertia, inertia);
  return w.add(d);
}

Pose at(const Vec3& x, const Quat& q = Quat::Identity()) {
  return {x, q};
}

/// Both kinds of world, stepped with values of coordinates followed.
struct Realtime : JointWorld {
  void tie(const JointCoupling& c) {
    couplings.push_back(c);
    links.push_back({joints[c.a].b, joints[c.b].b});
    joints[c.a].coupled |= uint8_t(1u << c.x);
    joints[c.b].coupled |= uint8_t(1u << c.y);
  }
  void advance() { step(); }
};
struct Event : EventWorld {
  void tie(const JointCoupling& c) { couplings.push_back(c); }
  void advance() {
    step();
    for (Joint& j : joints) follow_coordinates(j, bodies, h);
  }
};

template <class World>
void check_gear() {
  for (const double n : {-2.5, 60.0}) {
    World w;
    w.gravity.setZero();
    const double I1 = 0.02, I2 = 0.3, torque = 0.05;
    const uint32_t first = wheel(w, {0, 1, 0}, 1, I1), second = wheel(w, {1, 1, 0}, 3, I2);
    w.join(JointKind::revolute, no_body, first, at({0, 1, 0}));
    w.join(JointKind::revolute, no_body, second, at({1, 1, 0}));
    w.tie({0, 1, 0, 0, n, 0});
    // A push with the turning, as of a motor: the wheel speeds up all the same from the start.
    w.bodies[first].omega.z() = n;
    w.bodies[second].omega.z() = 1;
    for (int i = 0; i < 60; ++i) w.advance();
    CHECK(w.bodies[first].omega.z() == doctest::Approx(n).epsilon(1e-9));
    w.bodies[first].omega.z() += torque / I1;
    for (int i = 0; i < 60; ++i) w.advance();
    // The angular momentum that the teeth pass on, seen from the first wheel.
    const double after = n + torque / (I1 + I2 / (n * n));
    CHECK(w.bodies[first].omega.z() == doctest::Approx(after).epsilon(1e-6));
    CHECK(w.bodies[second].omega.z() == doctest::Approx(after / n).epsilon(1e-6));
    CHECK(std::fabs(w.joints[0].value[0] - n * w.joints[1].value[0]) < 1e-5 * std::fabs(n));
    CHECK(w.joint_error() < 1e-7);
  }
}

template <class World>
void check_screw() {
  World w;
  const double mass = 2, inertia = 0.004, lead = 0.05 / (2 * std::numbers::pi);
  const uint32_t nut = wheel(w, {0, 5, 0}, mass, inertia);
  w.join(JointKind::cylindrical, no_body, nut,
         at({0, 5, 0}, rotation_between(Vec3::UnitZ(), Vec3::UnitY())));
  w.tie({0, 0, 0, 1, lead, 0});
  for (int i = 0; i < 180; ++i) w.advance();
  const double a = g / (1 + inertia / (mass * lead * lead));
  CHECK(w.bodies[nut].v.y() == doctest::Approx(-3 * a).epsilon(1e-6));
  CHECK(w.bodies[nut].pose.x.y() == doctest::Approx(5 - 4.5 * a).epsilon(1e-5));
  CHECK(w.joints[0].value[1] < -20 * std::numbers::pi);
  CHECK(w.joints[0].value[0] == doctest::Approx(lead * w.joints[0].value[1]).epsilon(1e-6));
}

template <class World>
void check_planet() {
  World w;
  w.gravity.setZero();
  const double Ic = 0.05, Ip = 0.002, mass = 0.4, R = 0.3, r = 0.1, spin = 2;
  const uint32_t carrier = wheel(w, {0, 1, 0}, 1, Ic), planet = wheel(w, {R + r, 1, 0}, mass, Ip);
  w.join(JointKind::revolute, no_body, carrier, at({0, 1, 0}));
  w.join(JointKind::revolute, carrier, planet, at({R + r, 1, 0}));
  w.tie({1, 0, 0, 0, R / r, 0});
  // The carrier alone is set going: the joints and teeth take the planet along.
  w.bodies[carrier].omega.z() = spin;
  for (int i = 0; i < 90; ++i) w.advance();
  const double whole = Ic + mass * (R + r) * (R + r) + Ip * (1 + R / r) * (1 + R / r);
  const double omega = Ic * spin / whole;
  CHECK(w.bodies[carrier].omega.z() == doctest::Approx(omega).epsilon(1e-4));
  CHECK(w.bodies[planet].omega.z() == doctest::Approx(omega * (1 + R / r)).epsilon(1e-4));
}

}  // namespace

TEST_CASE("gears pass on angular momentum by their ratio, under either solver") {
  check_gear<Realtime>();
  check_gear<Event>();
}

TEST_CASE("a screw falls with g / (1 + I (2 pi / pitch)^2 / m), under either solver") {
  check_screw<Realtime>();
  check_screw<Event>();
}

TEST_CASE("both coordinates of a coupling may be of joints of one body: a planet on its carrier") {
  check_planet<Realtime>();
  check_planet<Event>();
}

TEST_CASE("a motor turns a coupling of any ratio at its rate from the start") {
  for (const double n : {0.1, 1.0, 10.0})
    for (const bool on_first : {true, false}) {
      CAPTURE(n);
      CAPTURE(on_first);
      Realtime w;
      w.gravity.setZero();
      const uint32_t first = wheel(w, {0, 1, 0}, 1, 1), second = wheel(w, {1, 1, 0}, 1, 1);
      w.join(JointKind::revolute, no_body, first, at({0, 1, 0}));
      w.join(JointKind::revolute, no_body, second, at({1, 1, 0}));
      w.tie({0, 1, 0, 0, n, 0});
      JointDrives drives;
      drives[0].motor.kind = MotorKind::velocity;
      drives[0].motor.target = 1;
      w.joints[on_first ? 0 : 1].drives = std::make_shared<JointDrives>(drives);
      for (int i = 0; i < 120; ++i) w.advance();
      const double driven = on_first ? 1 / n : n;
      CHECK(w.joints[on_first ? 0 : 1].value[0] == doctest::Approx(2).epsilon(1e-5));
      CHECK(w.joints[on_first ? 1 : 0].value[0] == doctest::Approx(2 * driven).epsilon(1e-5));
      CHECK(w.kinetic_energy() == doctest::Approx(0.5 * (1 + driven * driven)).epsilon(1e-6));
    }
}
