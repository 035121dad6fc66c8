// Hard limits, motors that hold a rate, dry friction and armature of joints under the event
// stepper. References: closed forms of one degree of freedom (bounces, ramps, brakes, statics), the
// energy of the physical pendulum, and elastic collisions of point masses.
#include "engine/math/rotation.hpp"
#include "tests/dynamics/event_world.hpp"
#include "tests/dynamics/joint_world.hpp"

#include <cmath>
#include <memory>
#include <numbers>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double gravity_here = 9.81;

CoordinateDrive rate_motor(double target, double most = no_bound) {
  CoordinateDrive d;
  d.motor.kind = MotorKind::velocity;
  d.motor.target = target;
  d.motor.max_force = most;
  return d;
}

CoordinateDrive limits(double lower, double upper, double restitution = 0) {
  CoordinateDrive d;
  d.limits.lower = lower;
  d.limits.upper = upper;
  d.limits.restitution = restitution;
  return d;
}

/// Bodies whose joints' coordinates are followed from tick to tick.
struct DrivenWorld : EventWorld {
  using EventWorld::EventWorld;
  void tick() {
    step();
    for (Joint& j : joints) follow_coordinates(j, bodies, h);
  }
  void go(double seconds) {
    const int n = int(seconds / h + 0.5);
    for (int i = 0; i < n; ++i) tick();
  }
  void drive(size_t joint, size_t coordinate, const CoordinateDrive& d) {
    JointDrives all = joints[joint].drives ? *joints[joint].drives : JointDrives{};
    all[coordinate] = d;
    joints[joint].drives = std::make_shared<JointDrives>(all);
    follow_coordinates(joints[joint], bodies, 0);
  }
  /// Mean over the last tick of what acts along a coordinate.
  double force(size_t joint, size_t coordinate = 0) const {
    return joints[joint].moving_force[row_count(joints[joint].kind) + coordinate];
  }
  double time() const { return ticks * h; }
};

/// A bar of 2 kg on a hinge through its centre (z axis), without gravity.
struct EventWheel : DrivenWorld {
  double inertia = 0;
  explicit EventWheel(const CoordinateDrive& d, double hz = 60) : DrivenWorld(hz) {
    gravity.setZero();
    BodyDef bar = body(box(0.5, 0.05, 0.05), Vec3::Zero());
    bar.mass = 2;
    add(bar);
    inertia = bodies[0].inertia_body(2, 2);
    join(JointKind::revolute, no_body, 0, {});
    drive(0, 0, d);
  }
  double angle() const { return joints[0].value[0]; }
  double rate() const { return bodies[0].omega.z(); }
};

/// A block of 3 kg on a vertical rail; the coordinate is its height.
struct EventSlider : DrivenWorld {
  static constexpr double mass = 3, weight = mass * gravity_here;
  EventSlider(double height, const CoordinateDrive& d, double hz = 60) : DrivenWorld(hz) {
    BodyDef block = body(box(0.1, 0.1, 0.1), {0, height, 0});
    block.mass = mass;
    add(block);
    join(JointKind::prismatic, no_body, 0, frame_along({0, height, 0}, {0, 1, 0}, {1, 0, 0}));
    joints[0].frame_a.x.setZero();
    drive(0, 0, d);
  }
  double height() const { return bodies[0].pose.x.y(); }
  double speed() const { return bodies[0].v.y(); }
};

/// A rod of 1 m and 2 kg on a hinge at its end, hanging at angle 0, let go at `start`.
struct EventPendulum : DrivenWorld {
  static constexpr double mass = 2, arm = 0.5;
  double inertia = 0;  ///< about the hinge
  EventPendulum(double start, const CoordinateDrive& d, double hz = 60) : DrivenWorld(hz) {
    BodyDef rod = body(box(0.05, 0.5, 0.05), {0, -arm, 0});
    rod.mass = mass;
    add(rod);
    inertia = bodies[0].inertia_body(2, 2) + mass * arm * arm;
    join(JointKind::revolute, no_body, 0, {});
    bodies[0].pose.q = axis_angle(Vec3::UnitZ(), start);
    bodies[0].pose.x = bodies[0].pose.q * Vec3(0, -arm, 0);
    drive(0, 0, d);
  }
  double angle() const { return joints[0].value[0]; }
  double rate() const { return bodies[0].omega.z(); }
  /// What gravity lost between two angles.
  double fall(double from, double to) const {
    return mass * gravity_here * arm * (std::cos(to) - std::cos(from));
  }
};

/// Height and speed of what falls from rest at `height` and bounces at 0.
std::pair<double, double> bounce(double height, double e, double t) {
  double v = std::sqrt(2 * gravity_here * height), first = v / gravity_here;
  if (t < first) return {height - 0.5 * gravity_here * t * t, -gravity_here * t};
  t -= first;
  for (v *= e; t > 2 * v / gravity_here; v *= e) t -= 2 * v / gravity_here;
  return {v * t - 0.5 * gravity_here * t * t, v - gravity_here * t};
}

}  // namespace

TEST_CASE("event: bounces on a hard limit happen at their times, with its restitution") {
  for (const double e : {0.3, 0.8, 1.0}) {
    EventSlider s(1, limits(0, no_bound, e));
    for (int i = 0; i < 48; ++i) {  // the series with 0.3 ends at 0.84 s
      s.tick();
      const auto [height, speed] = bounce(1, e, s.time());
      CHECK(std::fabs(s.height() - height) < 1e-9);
      CHECK(std::fabs(s.speed() - speed) < 1e-8);
    }
  }
}

TEST_CASE("event: a series of bounces ends on the limit, which bears the weight exactly") {
  EventSlider s(0.5, limits(0, no_bound, 0.5));
  s.go(3);
  CHECK(std::fabs(s.height()) < 1e-12);
  CHECK(std::fabs(s.speed()) < 1e-12);
  CHECK(s.force(0) == doctest::Approx(EventSlider::weight).epsilon(1e-12));
  CHECK(s.joints[0].motor_impulse[0] == 0);
}

TEST_CASE("event: an upper limit holds from above, and what leaves it by itself is let go") {
  EventSlider s(-0.2, limits(-no_bound, 0));
  s.gravity = -s.gravity;
  s.go(1);
  CHECK(std::fabs(s.height()) < 1e-12);
  CHECK(s.force(0) == doctest::Approx(-EventSlider::weight).epsilon(1e-12));
  s.gravity = -s.gravity;
  const double from = s.time();
  s.go(0.5);
  CHECK(s.speed() == doctest::Approx(-gravity_here * (s.time() - from)).epsilon(1e-9));
  CHECK(s.force(0) == 0);
}

TEST_CASE(
    "event: a pendulum comes back from a limit with e times its rate, to the height of that") {
  const double e = 0.6, stop = 0.2, start = -1.2;
  EventPendulum p(start, limits(-no_bound, stop, e), 120);
  double fastest = 0, after = 0, lowest = 0;
  while (p.time() < 1.5) {
    p.tick();
    CHECK(p.angle() < stop + 1e-9);
    if (after == 0) fastest = std::max(fastest, p.rate());
    if (p.rate() < 0 && after == 0) after = p.rate();
    if (after != 0) lowest = std::min(lowest, p.angle());
    if (after != 0 && p.rate() > 0) break;
  }
  // Energy at the limit, before and after.
  const double swing = e * e * p.fall(start, stop);
  const double expected = -std::acos(std::cos(stop) - swing / (p.mass * gravity_here * p.arm));
  CHECK(lowest == doctest::Approx(expected).epsilon(1e-3));
  const double at = p.angle();
  CHECK(0.5 * p.inertia * p.rate() * p.rate() ==
        doctest::Approx(swing - p.fall(at, stop)).epsilon(1e-7));
}

TEST_CASE(
    "event: a pendulum that rests on a limit leaves it its moment, and the hinge its weight") {
  const double stop = 0.7;
  EventPendulum p(1.4, limits(stop, no_bound, 0.3));
  p.go(3);
  CHECK(std::fabs(p.angle() - stop) < 1e-12);
  CHECK(std::fabs(p.rate()) < 1e-12);
  const double moment = p.mass * gravity_here * p.arm * std::sin(stop);
  CHECK(p.force(0) == doctest::Approx(moment).epsilon(1e-9));
  Vec3 hinge = Vec3::Zero();
  for (int k = 0; k < 3; ++k) hinge[k] = p.joints[0].moving_force[size_t(k)];
  CHECK(hinge.norm() == doctest::Approx(p.mass * gravity_here).epsilon(1e-9));
}

TEST_CASE("event: a capped motor ramps a wheel up to its rate, and has no force then") {
  for (const double most : {0.5, 4.0}) {
    EventWheel w(rate_motor(3, most));
    const double ramp = 3 * w.inertia / most;
    for (int i = 0; i < 120; ++i) {
      w.tick();
      const double t = w.time();
      CHECK(std::fabs(w.rate() - std::min(most * t / w.inertia, 3.0)) < 1e-10);
      const double way = t < ramp ? 0.5 * most * t * t / w.inertia : 3 * (t - 0.5 * ramp);
      CHECK(std::fabs(w.angle() - way) < 1e-7);  // of the integrator: a quarter of a radian a step
    }
    CHECK(std::fabs(w.force(0)) < 1e-9);
    CHECK(w.angle() > std::numbers::pi);
  }
}

TEST_CASE("event: a motor of any strength has its rate at once, and keeps it against a load") {
  EventSlider s(1, rate_motor(-0.5));
  s.tick();
  CHECK(s.speed() == doctest::Approx(-0.5).epsilon(1e-12));
  s.go(1);
  CHECK(s.height() == doctest::Approx(1 - 0.5 * s.time()).epsilon(1e-10));
  CHECK(s.force(0) == doctest::Approx(EventSlider::weight).epsilon(1e-9));
  CHECK(s.joints[0].motor_impulse[0] == doctest::Approx(EventSlider::weight * s.h).epsilon(1e-9));
}

TEST_CASE("event: a capped motor holds a load up to its cap, and lowers it with the rest beyond") {
  EventSlider held(1, rate_motor(0, EventSlider::weight + 0.01));
  EventSlider loose(1, rate_motor(0, EventSlider::weight - 6));
  held.go(1);
  loose.go(1);
  CHECK(held.height() == doctest::Approx(1).epsilon(1e-12));
  CHECK(held.force(0) == doctest::Approx(EventSlider::weight).epsilon(1e-9));
  CHECK(loose.speed() == doctest::Approx(-2).epsilon(1e-9));
  CHECK(loose.height() == doctest::Approx(0).epsilon(1e-9));
  CHECK(loose.force(0) == doctest::Approx(EventSlider::weight - 6).epsilon(1e-12));
}

TEST_CASE("event: a motor of any strength stands at a limit, and leaves it when it is turned") {
  EventSlider s(1, [] {
    CoordinateDrive d = limits(0.5, 1.5, 0.7);
    d.motor = rate_motor(-1).motor;
    return d;
  }());
  s.go(1);
  CHECK(std::fabs(s.height() - 0.5) < 1e-9);
  CHECK(std::fabs(s.speed()) < 1e-9);
  CoordinateDrive d = (*s.joints[0].drives)[0];
  d.motor.target = 0.25;
  s.drive(0, 0, d);
  s.go(1);
  CHECK(s.height() == doctest::Approx(0.75).epsilon(1e-9));
}

TEST_CASE("event: dry friction brings a wheel to a stand at I w / T, where it stays") {
  CoordinateDrive d;
  d.friction = 0.4;
  EventWheel w(d);
  const double omega = 2, stop = w.inertia * omega / d.friction;
  w.bodies[0].omega.z() = omega;
  follow_coordinates(w.joints[0], w.bodies, 0);
  for (int i = 0; i < 120; ++i) {
    w.tick();
    const double t = std::min(w.time(), stop);
    CHECK(std::fabs(w.rate() - omega * (1 - t / stop)) < 1e-10);
    CHECK(std::fabs(w.angle() - omega * t * (1 - 0.5 * t / stop)) < 1e-8);
  }
  CHECK(std::fabs(w.rate()) < 1e-15);
}

TEST_CASE("event: friction holds a pendulum off the vertical up to its torque") {
  const double start = 0.6, moment = EventPendulum::mass * gravity_here * EventPendulum::arm;
  CoordinateDrive d;
  d.friction = 1.01 * moment * std::sin(start);
  EventPendulum held(start, d);
  held.go(2);
  CHECK(held.angle() == doctest::Approx(start).epsilon(1e-12));
  CHECK(held.force(0) == doctest::Approx(moment * std::sin(start)).epsilon(1e-9));
  d.friction = 0.5 * moment * std::sin(start);
  EventPendulum swings(start, d);
  swings.go(10);
  // It comes to rest where friction holds it, and on its way the work of friction is all that goes.
  CHECK(std::fabs(moment * std::sin(swings.angle())) < d.friction);
  CHECK(std::fabs(swings.rate()) < 1e-12);
  const double turned = swings.fall(start, swings.angle()) / d.friction;
  CHECK(turned > start - swings.angle() - 1e-7);
}

TEST_CASE("event: a motor and a brake share: the motor gives what friction takes") {
  CoordinateDrive d = rate_motor(3, 1.0);
  d.friction = 0.4;
  EventWheel w(d);
  for (int i = 0; i < 120; ++i) {
    w.tick();
    CHECK(std::fabs(w.rate() - std::min(0.6 * w.time() / w.inertia, 3.0)) < 1e-10);
  }
  CHECK(std::fabs(w.force(0)) < 1e-9);
  CHECK(w.joints[0].motor_impulse[0] == doctest::Approx(0.4 * w.h).epsilon(1e-9));
  d.motor.target = 0;
  w.drive(0, 0, d);
  w.go(2);
  CHECK(std::fabs(w.rate()) < 1e-12);
}

TEST_CASE("event: a target that changes evenly is followed, and needs inertia times its change") {
  CoordinateDrive d = rate_motor(0, 50);
  d.motor.target_rate = 6;
  EventWheel w(d);
  for (int i = 0; i < 30; ++i) {
    w.tick();
    CHECK(w.rate() == doctest::Approx(6 * w.time()).epsilon(1e-10));
    CHECK(w.force(0) == doctest::Approx(6 * w.inertia).epsilon(1e-9));
    CoordinateDrive next = d;
    next.motor.target = 6 * w.time();
    w.drive(0, 0, next);
  }
}

TEST_CASE("event: armature is inertia along the coordinate, for forces") {
  CoordinateDrive d;
  d.armature = EventSlider::mass;
  EventSlider s(1, d);
  s.go(0.5);
  CHECK(s.speed() == doctest::Approx(-0.5 * gravity_here * s.time()).epsilon(1e-12));
  // A pendulum at the bottom of its swing.
  d.armature = 0.4;
  EventPendulum p(-1.5, d, 240);
  double before = 0, error = 1;
  while (p.angle() < 0) {
    p.tick();
    before = 0.5 * (p.inertia + d.armature) * p.rate() * p.rate();
    error = std::fabs(before - p.fall(-1.5, p.angle()));
    REQUIRE(p.ticks < 1000);
  }
  CHECK(error < 1e-8);
  CHECK(before == doctest::Approx(p.fall(-1.5, 0)).epsilon(1e-3));
}

TEST_CASE("event: a pendulum with armature swings in its period") {
  // Small: 2 pi sqrt((I + armature) / (m g l)), longer by amplitude^2 / 16.
  CoordinateDrive d;
  d.armature = 1;
  const double start = 0.02;
  EventPendulum p(start, d, 240);
  const double w = std::sqrt(p.mass * gravity_here * p.arm / (p.inertia + d.armature));
  const double period = 2 * std::numbers::pi / w * (1 + start * start / 16);
  p.go(3);
  CHECK(p.angle() ==
        doctest::Approx(start * std::cos(2 * std::numbers::pi * p.time() / period)).epsilon(1e-4));
}

TEST_CASE("event: armature is inertia for impulses too") {
  // A ball of 1 kg falls on a block of 3 kg on a rail with as much armature again, without
  // restitution or with all of it, as on 6 kg.
  for (const double e : {0.0, 0.5, 1.0}) {
    CoordinateDrive d;
    d.armature = EventSlider::mass;
    EventSlider s(1, d, 240);
    s.gravity.setZero();
    s.bodies[0].shapes[0].material.restitution = e;
    BodyDef ball = body(sphere(0.1), {0, 1.5, 0}, 0, e);
    ball.mass = 1;
    s.add(ball);
    s.bodies[1].v = {0, -4, 0};
    s.go(0.5);
    const double common = -4 * 1.0 / 7;
    CHECK(s.speed() == doctest::Approx(common * (1 + e)).epsilon(1e-9));
    CHECK(s.bodies[1].v.y() == doctest::Approx(common + e * 4 * 6.0 / 7).epsilon(1e-9));
  }
}

TEST_CASE("event: a ball on a block that rests on its limit bounces as from the limit") {
  for (const char* law : {"reflections", "sequential", "simultaneous_newton"}) {
    EventSlider s(0, limits(0, no_bound), 240);
    s.settings.impulses = law;
    s.bodies[0].shapes[0].material.restitution = 1;
    BodyDef ball = body(sphere(0.1), {0, 0.7, 0}, 0, 1);
    ball.mass = 1;
    s.add(ball);
    const double fall = 0.5, hit = std::sqrt(2 * gravity_here * fall);
    while (s.bodies[1].v.y() <= 0) {
      s.tick();
      REQUIRE(s.ticks < 240);
    }
    CHECK(std::fabs(s.height()) < 1e-9);
    CHECK(s.height() > -1e-9);
    // Reflections one after the other leave what an elastic collision with the free block leaves.
    const std::string name = law;
    const double speed = name == "simultaneous_newton" ? hit : hit * (3 - 1) / (3 + 1);
    const double back = s.bodies[1].v.y() + gravity_here * (s.time() - hit / gravity_here);
    CHECK(back == doctest::Approx(speed).epsilon(1e-8));
  }
}

TEST_CASE("event: a block on a friction drive and a rope that becomes taut") {
  // A rope is a free joint with an upper limit.
  DrivenWorld w;
  BodyDef bob = body(sphere(0.1), {0, -0.1, 0});
  bob.mass = 2;
  w.add(bob);
  w.join(JointKind::free, no_body, 0, {});
  w.joints[0].frame_b.x.setZero();
  w.joints[0].frame_a.x.setZero();
  w.drive(0, 0, limits(-no_bound, 1));
  const double fall = std::sqrt(2 * 0.9 / gravity_here);
  const int slack = int(fall / w.h);
  for (int i = 0; i < slack; ++i) w.tick();
  CHECK(w.bodies[0].v.y() == doctest::Approx(-gravity_here * w.time()).epsilon(1e-9));
  w.go(1);
  CHECK(w.bodies[0].pose.x.y() == doctest::Approx(-1).epsilon(1e-9));
  CHECK(w.bodies[0].v.norm() < 1e-9);
  CHECK(w.force(0) == doctest::Approx(-2 * gravity_here).epsilon(1e-9));
}

TEST_CASE("event: what begins beyond its limit is brought back at the recovery speed") {
  EventWheel w(limits(0.1, no_bound, 0.5));
  double before = 0;
  for (int i = 0; i < 200; ++i) {
    w.tick();
    CHECK(w.angle() - before < w.settings.recovery_speed * w.h + 1e-9);
    CHECK(std::fabs(w.rate()) < 1e-12);
    before = w.angle();
  }
  CHECK(w.angle() == doctest::Approx(0.1).epsilon(1e-9));
}

TEST_CASE("event: swing and twist of a ball joint stay within their limits") {
  for (const double spin : {9.0, -9.0}) {
    DrivenWorld w(240);
    BodyDef d = body(capsule(0.1, 0.4), {0, -0.4, 0});
    d.mass = 1;
    w.add(d);
    w.join(JointKind::spherical, no_body, 0, frame_along({0, 0, 0}, {0, -1, 0}, {1, 0, 0}));
    w.drive(0, 0, limits(-no_bound, 0.6, 0.2));
    w.drive(0, 1, limits(-0.3, 0.5));
    w.bodies[0].omega = {6, spin, -4};
    w.bodies[0].v = w.bodies[0].omega.cross(w.bodies[0].pose.x);
    double widest = 0, most = -1, least = 1;
    for (int i = 0; i < 600; ++i) {
      w.tick();
      widest = std::max(widest, w.joints[0].value[0]);
      most = std::max(most, w.joints[0].value[1]);
      least = std::min(least, w.joints[0].value[1]);
    }
    CHECK(widest > 0.55);
    CHECK(widest < 0.6 + 1e-9);
    CHECK(most < 0.5 + 1e-9);
    CHECK(least > -0.3 - 1e-9);
    CHECK((spin > 0 ? least < -0.295 : most > 0.495));
    CHECK(w.joint_error() < 1e-9);
  }
}

TEST_CASE("event: a wheel with a capped motor drives a car by friction with the ground") {
  // A ball of radius r rolls along x; its axle, which does not turn, is held by a carriage that
  // goes up and down. Torque T at the axle: a = T / (r (m + I / r^2)), as long as friction holds.
  DrivenWorld w(240);
  const double r = 0.3, torque = 2;
  BodyDef ground = body(box(20, 0.5, 5), {0, -0.5, 0}, 1);
  ground.type = BodyType::fixed;
  w.add(ground);
  BodyDef axle = body(box(0.1, 0.05, 0.1), {0, r, 0}, 1);
  axle.mass = 4;
  w.add(axle);
  BodyDef disc = body(sphere(r), {0, r, 0}, 1);
  disc.mass = 2;
  w.add(disc);
  w.join(JointKind::revolute, 1, 2, {{0, r, 0}, Quat::Identity()});
  BodyDef carriage = body(box(0.1, 0.1, 0.1), {0, 3, 0});
  carriage.mass = 1;
  w.add(carriage);
  w.join(JointKind::prismatic, no_body, 3, frame_along({0, 3, 0}, {0, 1, 0}, {1, 0, 0}));
  w.join(JointKind::prismatic, 3, 1, frame_along({0, r, 0}, {1, 0, 0}, {0, 1, 0}));
  w.drive(0, 0, rate_motor(-4, torque));
  const double inertia = w.bodies[2].inertia_body(2, 2);
  const double a = torque / (r * (6 + inertia / (r * r)));
  w.go(0.5);
  CHECK(w.bodies[1].v.x() == doctest::Approx(a * w.time()).epsilon(1e-6));
  w.go(2);
  CHECK(w.bodies[1].v.x() == doctest::Approx(4 * r).epsilon(1e-9));
}

TEST_CASE("event: parts along dependent rows: a door on two hinges, limits that leave no way") {
  DrivenWorld w(240);
  BodyDef door = body(box(0.4, 1, 0.02), {0.4, 0, 0});
  door.mass = 10;
  w.add(door);
  for (const double y : {-0.8, 0.8})
    w.join(JointKind::revolute, no_body, 0, frame_along({0, y, 0}, {0, 1, 0}, {1, 0, 0}));
  CoordinateDrive brake = limits(-no_bound, 1.2, 0);
  brake.friction = 0.5;
  w.drive(0, 0, brake);
  w.drive(1, 0, brake);
  w.bodies[0].omega = {0, 2, 0};
  w.bodies[0].v = w.bodies[0].omega.cross(w.bodies[0].pose.x);
  const double inertia = w.bodies[0].inertia_body(1, 1) + 10 * 0.4 * 0.4;
  w.go(0.25);
  CHECK(w.bodies[0].omega.y() == doctest::Approx(2 - 2 * 0.5 * w.time() / inertia).epsilon(1e-7));
  w.go(2);
  CHECK(w.joints[0].value[0] == doctest::Approx(1.2).epsilon(1e-9));
  CHECK(w.bodies[0].omega.norm() < 1e-9);

  EventSlider locked(0.4, limits(0.4, 0.4));
  locked.go(1);
  CHECK(locked.height() == doctest::Approx(0.4).epsilon(1e-12));
  CHECK(locked.force(0) == doctest::Approx(EventSlider::weight).epsilon(1e-9));
}

TEST_CASE("event: limits go on in windows of a tick, and any number of threads does the same") {
  double heights[2];
  for (const int threads : {1, 3}) {
    DrivenWorld w(60, threads);
    w.max_untied_bodies = 1;
    for (int i = 0; i < 6; ++i) {
      const Vec3 at(0.25 * i, 1 + 0.1 * i, 0);
      BodyDef d = body(box(0.1, 0.1, 0.1), at);
      d.mass = 3;
      const uint32_t slot = w.add(d);
      w.join(JointKind::prismatic, no_body, slot, frame_along(at, {0, 1, 0}, {1, 0, 0}));
      w.joints.back().frame_a.x.y() = 0;
      w.drive(size_t(i), 0, limits(0, no_bound, 0.5));
      BodyDef ball = body(sphere(0.05), at + Vec3(0, 0.3, 0), 0, 0.5);
      ball.mass = 0.1;
      w.add(ball);
    }
    w.go(0.75);
    heights[threads == 1 ? 0 : 1] = w.bodies[4].pose.x.y() + w.bodies[5].pose.x.y();
    CHECK(w.windows > 0);
  }
  CHECK(heights[0] == heights[1]);
}
