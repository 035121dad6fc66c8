// What acts along coordinates of joints under the realtime solver. References: closed forms of one
// degree of freedom (oscillator, step responses, brake, bounces), with the error of second order in
// the sub-step that the scheme has.
#include "engine/core/random.hpp"
#include "engine/math/rotation.hpp"
#include "tests/dynamics/joint_world.hpp"

#include <cmath>
#include <memory>
#include <numbers>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double g = 9.81;

/// A bar on a hinge through its centre (z axis), without gravity.
struct Wheel : JointWorld {
  uint32_t bar = 0;
  double inertia = 0;

  explicit Wheel(double hz = 60) : JointWorld(hz) {
    gravity.setZero();
    BodyDef d = body(box(0.5, 0.05, 0.05), Vec3::Zero());
    d.mass = 2;
    bar = add(d);
    inertia = bodies[bar].inertia_body(2, 2);
    join(JointKind::revolute, no_body, bar, {});
  }
  void drive(const CoordinateDrive& d) { set(0, 0, d); }
  double angle() const { return joints[0].value[0]; }
  double rate() const { return bodies[bar].omega.z(); }

  void set(size_t joint, size_t coordinate, const CoordinateDrive& d) {
    JointDrives all = joints[joint].drives ? *joints[joint].drives : JointDrives{};
    all[coordinate] = d;
    joints[joint].drives = std::make_shared<JointDrives>(all);
  }
};

/// A body that slides up and down a vertical rail; the coordinate is its height.
struct Slider : JointWorld {
  uint32_t block = 0;

  explicit Slider(double height, double hz = 60) : JointWorld(hz) {
    BodyDef d = body(box(0.1, 0.1, 0.1), {0, height, 0});
    d.mass = 3;
    block = add(d);
    // The rail's z axis points up, its frame begins at the origin.
    join(JointKind::prismatic, no_body, block, frame_along({0, height, 0}, {0, 1, 0}, {1, 0, 0}));
    joints[0].frame_a.x.setZero();
  }
  void drive(const CoordinateDrive& d) {
    JointDrives all;
    all[0] = d;
    joints[0].drives = std::make_shared<JointDrives>(all);
  }
  double height() const { return bodies[block].pose.x.y(); }
  double speed() const { return bodies[block].v.y(); }
};

CoordinateDrive spring(double stiffness, double damping, double rest = 0) {
  CoordinateDrive d;
  d.spring = {stiffness, damping, rest};
  return d;
}

CoordinateDrive motor(MotorKind kind, double target, double most = no_bound) {
  CoordinateDrive d;
  d.motor.kind = kind;
  d.motor.target = target;
  d.motor.max_force = most;
  return d;
}

/// x'' + 2 z w x' + w^2 x = 0 from x0 at rest.
double damped(double x0, double w, double z, double t) {
  if (z < 1) {
    const double wd = w * std::sqrt(1 - z * z);
    return x0 * std::exp(-z * w * t) * (std::cos(wd * t) + z * w / wd * std::sin(wd * t));
  }
  const double s = w * std::sqrt(z * z - 1), p = -z * w + s, q = -z * w - s;
  return x0 * (p * std::exp(q * t) - q * std::exp(p * t)) / (p - q);
}

}  // namespace

TEST_CASE("a torsion spring swings at its closed form, and the error falls with the square") {
  double errors[2];
  for (int i = 0; i < 2; ++i) {
    Wheel w(60 << i);
    w.drive(spring(8, 0, 0.4));
    w.run(2);
    const double omega = std::sqrt(8 / w.inertia);
    errors[i] = std::fabs(w.angle() - (0.4 - 0.4 * std::cos(omega * 2)));
  }
  CHECK(errors[0] < 2e-3);
  CHECK(errors[1] < 0.3 * errors[0]);
}

TEST_CASE("springs and dampers of any ratio decay by their closed form") {
  for (const double ratio : {0.2, 1.5, 8.0}) {
    Wheel w;
    const double omega = 6;
    w.drive(spring(omega * omega * w.inertia, 2 * ratio * omega * w.inertia, 1.0));
    for (int i = 0; i < 60; ++i) {
      w.step();
      const double expected = 1 + damped(-1, omega, ratio, w.h * (i + 1));
      CHECK_MESSAGE(std::fabs(w.angle() - expected) < 2e-3, ratio);
    }
  }
}

TEST_CASE("a motor that holds a rate gets there at its greatest torque, and stays there") {
  for (const double most : {0.5, 4.0}) {
    Wheel w;
    w.drive(motor(MotorKind::velocity, 3, most));
    for (int i = 0; i < 120; ++i) {
      w.step();
      const double t = w.h * (i + 1);
      CHECK(std::fabs(w.rate() - std::min(most * t / w.inertia, 3.0)) < 1e-9);
    }
    const double ramp = 3 * w.inertia / most;
    CHECK(std::fabs(w.angle() - 3 * (2 - 0.5 * ramp)) < 0.01);
    CHECK(w.angle() > std::numbers::pi);
  }
}

TEST_CASE("angles are counted over many turns, with and without something that acts") {
  Wheel w;
  w.bodies[w.bar].omega = {0, 0, 400};
  follow_coordinates(w.joints[0], w.bodies, 0);
  w.run(1);
  CHECK(w.angle() == doctest::Approx(400).epsilon(1e-6));
  w.drive(motor(MotorKind::velocity, -200));
  w.run(1);
  CHECK(w.angle() == doctest::Approx(200).epsilon(1e-3));
}

TEST_CASE("a position motor answers a step as the closed form of second order, and is capped") {
  Wheel w;
  CoordinateDrive d = motor(MotorKind::position, 0.8);
  const double omega = 10, ratio = 0.7;
  d.motor.stiffness = omega * omega * w.inertia;
  d.motor.damping = 2 * ratio * omega * w.inertia;
  w.drive(d);
  for (int i = 0; i < 60; ++i) {
    w.step();
    CHECK(std::fabs(w.angle() - 0.8 - damped(-0.8, omega, ratio, w.h * (i + 1))) < 2e-3);
  }
  Wheel capped;
  d.motor.max_force = 0.1;
  capped.drive(d);
  for (int i = 0; i < 20; ++i) {
    capped.step();
    CHECK(capped.rate() == doctest::Approx(0.1 * capped.h * (i + 1) / capped.inertia));
    CHECK(capped.joints[0].motor_impulse[0] == doctest::Approx(0.1 * capped.h));
  }
}

TEST_CASE("dry friction brings a wheel to a stand at I w / T, exactly") {
  Wheel w;
  const double torque = 0.4, omega = 2;
  CoordinateDrive d;
  d.friction = torque;
  w.drive(d);
  w.bodies[w.bar].omega.z() = omega;
  const double stop = w.inertia * omega / torque;
  for (int i = 0; i < 120; ++i) {
    w.step();
    const double t = w.h * (i + 1);
    CHECK(std::fabs(w.rate() - std::max(0.0, omega - torque * t / w.inertia)) < 1e-9);
  }
  CHECK(std::fabs(w.angle() - 0.5 * omega * stop) < 1e-2);
  CHECK(w.rate() == 0);
}

TEST_CASE("friction holds a load up to its force, and lets go beyond it") {
  Slider held(1), loose(1);
  CoordinateDrive d;
  d.friction = 3 * g + 0.01;
  held.drive(d);
  d.friction = 3 * g - 6;
  loose.drive(d);
  held.run(1);
  loose.run(1);
  CHECK(held.height() == doctest::Approx(1).epsilon(1e-12));
  CHECK(loose.speed() == doctest::Approx(-2).epsilon(1e-9));
}

TEST_CASE("a hard limit is never passed, and gives back what its restitution says") {
  for (const double e : {0.0, 0.5, 0.8, 1.0}) {
    Slider s(1);
    CoordinateDrive d;
    d.limits.lower = 0;
    d.limits.restitution = e;
    s.drive(d);
    double highest = 0, lowest = 1;
    const double fall = std::sqrt(2 / g);
    while (double(s.ticks) * s.h < fall + 1.9 * fall * e + 0.1) {
      s.step();
      lowest = std::min(lowest, s.height());
      if (double(s.ticks) * s.h > fall + 0.02 && double(s.ticks) * s.h < fall + 2 * fall * e)
        highest = std::max(highest, s.height());
    }
    CHECK(lowest > -1e-9);
    CHECK(std::fabs(highest - e * e) < 0.01);
  }
}

TEST_CASE("what begins beyond its limit is brought back to it, and not thrown") {
  Wheel w;
  CoordinateDrive d;
  d.limits.lower = 0.5;
  d.limits.restitution = 0.5;
  w.drive(d);
  double highest = 0;
  for (int i = 0; i < 60; ++i) {
    w.step();
    highest = std::max(highest, w.angle());
  }
  CHECK(w.angle() == doctest::Approx(0.5).epsilon(1e-9));
  CHECK(highest < 0.5 + 1e-9);
  CHECK(std::fabs(w.rate()) < 1e-9);
}

TEST_CASE("bounces on a limit come to rest on it") {
  Slider s(0.5);
  CoordinateDrive d;
  d.limits.lower = 0;
  d.limits.restitution = 0.5;
  s.drive(d);
  s.run(5);
  CHECK(std::fabs(s.height()) < 1e-9);
  CHECK(std::fabs(s.speed()) < 1e-9);
}

TEST_CASE("a stop that gives way yields by load over stiffness") {
  Slider s(0.2);
  CoordinateDrive d;
  d.limits.lower = 0;
  d.limits.stiffness = 1000;
  d.limits.damping = 50;
  s.drive(d);
  s.run(5);
  CHECK(s.height() == doctest::Approx(-3 * g / 1000).epsilon(1e-6));
}

TEST_CASE("armature adds to the inertia along a coordinate and to nothing else") {
  Wheel w;
  CoordinateDrive d = motor(MotorKind::force, 0.6);
  d.armature = 0.5;
  w.drive(d);
  w.run(1);
  CHECK(w.rate() == doctest::Approx(0.6 / (w.inertia + 0.5)).epsilon(1e-6));
  Slider s(1);
  CoordinateDrive heavy;
  heavy.armature = 3;
  s.drive(heavy);
  s.run(1);
  CHECK(s.speed() == doctest::Approx(-g / 2).epsilon(1e-6));
}

TEST_CASE("springs of any stiffness stay stable for a thousand ticks") {
  for (const double stiffness : {1e4, 1e8})
    for (const double damping : {0.0, 1e3, 1e8}) {
      Slider s(1);
      s.drive(spring(stiffness, damping, 1.01));
      const double start = 0.5 * stiffness * 1e-4;
      double energy = 0;
      for (int i = 0; i < 1000; ++i) {
        s.step();
        const double stretch = s.height() - 1.01;
        energy = 0.5 * stiffness * stretch * stretch + 0.5 * 3 * s.speed() * s.speed();
        REQUIRE(energy < 1.02 * start + 1);
      }
      if (damping == 0 && stiffness == 1e4) CHECK(energy > 0.5 * start);
    }
}

TEST_CASE("several coordinates of one joint: swing and twist stay within their limits") {
  for (const double spin : {9.0, -9.0}) {
    JointWorld w;
    BodyDef d = body(capsule(0.1, 0.4), {0, -0.4, 0});
    d.mass = 1;
    const uint32_t arm = w.add(d);
    // The z axis points down the arm.
    w.join(JointKind::spherical, no_body, arm, frame_along({0, 0, 0}, {0, -1, 0}, {1, 0, 0}));
    JointDrives all;
    all[0].limits.upper = 0.6;
    all[1].limits.lower = -0.3;
    all[1].limits.upper = 0.5;
    w.joints[0].drives = std::make_shared<JointDrives>(all);
    w.bodies[arm].omega = {6, spin, -4};
    w.bodies[arm].v = w.bodies[arm].omega.cross(w.bodies[arm].pose.x);
    double widest = 0, most = -1, least = 1;
    for (int i = 0; i < 300; ++i) {
      w.step();
      widest = std::max(widest, w.joints[0].value[0]);
      most = std::max(most, w.joints[0].value[1]);
      least = std::min(least, w.joints[0].value[1]);
    }
    CHECK(widest > 0.55);
    CHECK(widest < 0.61);
    CHECK(most < 0.505);
    CHECK(least > -0.305);
    CHECK((spin > 0 ? least < -0.295 : most > 0.495));
    CHECK(w.joint_error() < 1e-4);
  }
}

TEST_CASE("a rope is a free joint with an upper limit: slack, then taut") {
  JointWorld w;
  BodyDef d = body(sphere(0.1), {0, 0, 0});
  d.mass = 2;
  const uint32_t bob = w.add(d);
  w.join(JointKind::free, no_body, bob, {});
  JointDrives all;
  all[0].limits.upper = 1;
  w.joints[0].drives = std::make_shared<JointDrives>(all);
  const double fall = std::sqrt(2 / g);
  w.run(0.9 * fall);
  CHECK(w.bodies[bob].v.y() == doctest::Approx(-g * double(w.ticks) * w.h).epsilon(1e-9));
  w.run(1);
  CHECK(w.bodies[bob].pose.x.y() == doctest::Approx(-1).epsilon(1e-6));
  CHECK(w.bodies[bob].v.norm() < 1e-6);
  CHECK(w.joints[0].impulse.force.y() > 0);
}

TEST_CASE("a motor does not fight its own hinge: an arm off its pivot follows at once") {
  JointWorld w;
  w.gravity.setZero();
  BodyDef d = body(box(0.5, 0.05, 0.05), {0.5, 0, 0});
  d.mass = 1;
  const uint32_t arm = w.add(d);
  w.join(JointKind::revolute, no_body, arm, {});
  JointDrives all;
  all[0] = motor(MotorKind::velocity, 2);
  w.joints[0].drives = std::make_shared<JointDrives>(all);
  w.run(1);
  CHECK(w.bodies[arm].omega.z() == doctest::Approx(2).epsilon(1e-6));
  CHECK((w.bodies[arm].pose.x - Vec3(0.5 * std::cos(2), 0.5 * std::sin(2), 0)).norm() < 0.02);
}

// Two sweeps over thirteen joints of one frame leave it a thousandth of the wheels' speed.
TEST_CASE("ordinary islands do the same: wheels with motors and brakes on one frame") {
  JointWorld w;
  w.gravity.setZero();
  BodyDef frame = body(box(7, 0.1, 0.1), {0, 0, -1});
  frame.mass = 20;
  const uint32_t base = w.add(frame);
  w.join(JointKind::rigid, no_body, base, {{0, 0, -1}, Quat::Identity()});
  const int n = 12;
  std::vector<uint32_t> wheels;
  for (int i = 0; i < n; ++i) {
    BodyDef d = body(box(0.4, 0.05, 0.05), {i - 6.0, 0, 0});
    d.mass = 2;
    wheels.push_back(w.add(d));
    w.join(JointKind::revolute, base, wheels.back(), {{i - 6.0, 0, 0}, Quat::Identity()});
    JointDrives all;
    all[0] = motor(MotorKind::velocity, 3, 1 + 0.1 * i);
    all[0].friction = 0.2;
    w.joints.back().drives = std::make_shared<JointDrives>(all);
  }
  for (int i = 0; i < 60; ++i) {
    w.step();
    const double t = w.h * (i + 1), inertia = w.bodies[wheels[0]].inertia_body(2, 2);
    for (int k = 0; k < n; ++k)
      CHECK(std::fabs(w.bodies[wheels[size_t(k)]].omega.z() -
                      std::min((0.8 + 0.1 * k) * t / inertia, 3.0)) < 2e-3);
  }
  CHECK(w.solve_stats.joints == size_t(n + 1));
}

TEST_CASE("a chain held up by position motors sags by its moments over their stiffness") {
  JointWorld w;
  const int n = 5;
  const double stiffness = 4e3;
  for (int i = 0; i < n; ++i) {
    BodyDef d = body(box(0.1, 0.02, 0.02), {0.1 + 0.2 * i, 0, 0});
    d.mass = 0.5;
    const uint32_t link = w.add(d);
    const Pose at{{0.2 * i, 0, 0}, Quat::Identity()};
    w.join(JointKind::revolute, i == 0 ? no_body : link - 1, link, at);
    JointDrives all;
    all[0] = motor(MotorKind::position, 0);
    all[0].motor.stiffness = stiffness;
    all[0].motor.damping = 100;
    w.joints.back().drives = std::make_shared<JointDrives>(all);
  }
  w.run(10);
  for (int i = 0; i < n; ++i) {
    double moment = 0;
    for (int k = i; k < n; ++k) moment += 0.5 * g * (0.1 + 0.2 * (k - i));
    CHECK(w.joints[size_t(i)].value[0] == doctest::Approx(-moment / stiffness).epsilon(2e-2));
  }
}

namespace {

/// Three links of a metre under gravity, the first hinge at the origin, straight along x.
struct HeldChain : JointWorld {
  explicit HeldChain(double hz, const CoordinateDrive& root) : JointWorld(hz) {
    for (int i = 0; i < 3; ++i) {
      BodyDef d = body(box(0.05, 0.05, 0.05), {i + 0.5, 0, 0});
      d.mass = 1;
      d.inertia = Vec3(0.083, 0.083, 0.083);
      const uint32_t slot = add(d);
      join(JointKind::revolute, i == 0 ? no_body : slot - 1, slot,
           {{double(i), 0, 0}, Quat::Identity()});
    }
    JointDrives all;
    all[0] = root;
    joints[0].drives = std::make_shared<JointDrives>(all);
  }
};

}  // namespace

TEST_CASE("a chain on a root that a motor or a brake holds gains no energy and stays together") {
  // Elimination leaves the root a fourth of its compliance: sweeps that softened the kept rows
  // afterwards diverged, to 15 kJ and gaps of half a metre.
  CoordinateDrive brake;
  brake.friction = 500;
  for (const double hz : {60.0, 240.0, 1000.0})
    for (const CoordinateDrive& root : {motor(MotorKind::velocity, 0), brake}) {
      CAPTURE(hz);
      HeldChain w(hz, root);
      double most = 0;
      for (int i = 0; i < int(2 * hz); ++i) {
        w.step();
        most = std::max(most, w.energy());
      }
      CHECK(most < 1e-3);
      CHECK(w.energy() > -0.05);
      CHECK(std::fabs(w.joints[0].value[0]) < 1e-6);
      CHECK(w.joint_error() < 1e-3);
    }
}

TEST_CASE("a heavy armature at the root of a chain gains no energy") {
  CoordinateDrive rotor;
  rotor.armature = 10;
  HeldChain w(60, rotor);
  double most = 0;
  for (int i = 0; i < 120; ++i) {
    w.step();
    const double rate = w.bodies[0].omega.z();
    most = std::max(most, w.energy() + 0.5 * rotor.armature * rate * rate);
  }
  CHECK(most < 1e-2);
  CHECK(w.joint_error() < 1e-3);
}

TEST_CASE("a motor of any strength stands at a hard limit, however that bounces") {
  for (const double e : {0.0, 0.3, 1.0}) {
    CAPTURE(e);
    Wheel w;
    CoordinateDrive d = motor(MotorKind::velocity, 2);
    d.limits.upper = 0.5;
    d.limits.restitution = e;
    w.drive(d);
    w.run(0.2);
    CHECK(w.angle() == doctest::Approx(0.4).epsilon(1e-9));
    w.run(1);
    CHECK(w.angle() == doctest::Approx(0.5).epsilon(1e-9));
    CHECK(w.rate() == 0);
  }
}

TEST_CASE("between limits that are one a coordinate stands, however they bounce") {
  for (const double e : {0.0, 0.5, 1.0}) {
    CAPTURE(e);
    Wheel w;
    CoordinateDrive d;
    d.limits.lower = d.limits.upper = 0;
    d.limits.restitution = e;
    w.drive(d);
    w.bodies[w.bar].omega.z() = 3;
    w.run(1);
    CHECK(std::fabs(w.angle()) < 1e-9);
    CHECK(std::fabs(w.rate()) < 1e-9);
  }
}
