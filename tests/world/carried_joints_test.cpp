// Mean reactions of joints on bodies that follow courses, under both steppers. References: what
// holds a mass m in a lift of acceleration a bears m (g + a), whichever part of the joint it is;
// I a for the torque on a turntable; for a pendulum on a pivot that shakes, the change of momentum
// of Lagrange's equation, integrated by Runge-Kutta's method with steps of 1e-4 s. Impulses over a
// tick are momentum, so that steady loads are exact to rounding; under realtime the pendulum has an
// error of second order in the sub-step.
#include "engine/math/rotation.hpp"
#include "engine/math/time_course.hpp"
#include "tests/support/test_world.hpp"
#include "tests/support/why_not.hpp"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double g = 9.81, mass = 2, rise = 3, moment = 0.3;

std::shared_ptr<const TimeCourse> over_time(const std::string& text) {
  auto made = TimeCourse::expression(text);
  REQUIRE_MESSAGE(made.ok(), why_not(made));
  return std::make_shared<const TimeCourse>(*std::move(made));
}

WorldSettings with(const std::string& stepper, int hz = 60) {
  WorldSettings s;
  s.stepper = stepper;
  s.gravity = {0, -g, 0};
  s.tick = {hz, 1};
  return s;
}

/// Its z axis points up.
Quat upwards() {
  return axis_angle(Vec3::UnitX(), -0.5 * std::numbers::pi);
}

/// A load that a joint of kind `def.kind` holds on a kinematic body; the anchor is at the origin.
struct Carried : TestWorld {
  BodyId carrier, load;
  JointId joint;

  Carried(const WorldSettings& settings, const BodyCourse& course, JointDef def,
          const Vec3& place = Vec3::Zero())
      : TestWorld(settings) {
    BodyDef platform = box_def(Vec3::Zero(), {0.1, 0.1, 0.1});
    platform.type = BodyType::kinematic;
    platform.course = std::make_shared<const BodyCourse>(course);
    carrier = add(platform);
    BodyDef d;
    d.mass = mass;
    d.inertia = Vec3::Constant(moment);
    d.pose.x = place;
    load = add(d);
    def.a = carrier, def.b = load;
    def.frame_b.x = -place;
    const auto id = world->create_joint(def);
    REQUIRE_MESSAGE(id.ok(), why_not(id));
    joint = *id;
    apply();
  }
  JointFrame frame() const { return world->frame()->joints->front(); }
};

JointDef of_kind(JointKind kind, const CoordinateDrive& drive = {}) {
  JointDef def;
  def.kind = kind;
  def.drives[0] = drive;
  def.frame_a.q = def.frame_b.q = upwards();
  return def;
}

BodyCourse lift() {
  BodyCourse course;
  course.x[1] = over_time("1.5*t^2");
  return course;
}

struct Holder {
  const char* name;
  CoordinateDrive drive;
  bool motor;
};

/// Everything that can hold a slider against the weight.
std::vector<Holder> holders() {
  std::vector<Holder> out(5);
  out[0].name = "a hard limit";
  out[0].drive.limits.lower = 0;
  out[1].name = "a motor of unlimited force";
  out[1].drive.motor.kind = MotorKind::velocity;
  out[2].name = "a motor of limited force";
  out[2].drive.motor.kind = MotorKind::velocity;
  out[2].drive.motor.max_force = 3 * mass * (g + rise);
  out[3].name = "a servo";
  out[3].drive.motor.kind = MotorKind::position;
  out[3].drive.motor.stiffness = 2000;
  out[3].drive.motor.damping = 60;
  out[4].name = "friction";
  out[4].drive.friction = 3 * mass * (g + rise);
  for (Holder& h : out) h.motor = h.drive.motor.kind != MotorKind::none;
  return out;
}

}  // namespace

TEST_CASE("what hangs in a lift pulls with m (g + a) at each joint that can hold it") {
  const double weight = mass * (g + rise);
  for (const char* stepper : {"realtime", "event"})
    for (const JointKind kind : {JointKind::rigid, JointKind::spherical, JointKind::revolute}) {
      INFO(stepper, " ", std::string(entry_of(kind).name));
      Carried c(with(stepper), lift(), of_kind(kind), {0, -0.5, 0});
      for (int tick = 0; tick < 30; ++tick) {
        c.step();
        if (tick < 2) continue;  // the speed of the first tick is a start
        CHECK((c.frame().mean_force - Vec3(0, weight, 0)).norm() < 1e-6 * weight);
        CHECK(c.frame().mean_torque.norm() < 1e-6 * weight);
      }
    }
}

TEST_CASE("a beam in a lift bends its clamp with m (g + a) l") {
  const double weight = mass * (g + rise);
  for (const char* stepper : {"realtime", "event"}) {
    INFO(stepper);
    Carried c(with(stepper), lift(), of_kind(JointKind::rigid), {0.5, 0, 0});
    c.run(0.5);
    CHECK((c.frame().mean_force - Vec3(0, weight, 0)).norm() < 1e-6 * weight);
    CHECK((c.frame().mean_torque - Vec3(0, 0, 0.5 * weight)).norm() < 1e-6 * weight);
  }
}

TEST_CASE("limits, motors and friction in a lift bear m (g + a)") {
  const double weight = mass * (g + rise);
  for (const char* stepper : {"realtime", "event"})
    for (const Holder& holder : holders()) {
      INFO(std::string(stepper), " ", std::string(holder.name));
      Carried c(with(stepper), lift(), of_kind(JointKind::prismatic, holder.drive));
      c.run(1);
      CHECK((c.frame().mean_force - Vec3(0, weight, 0)).norm() < 1e-4 * weight);
      if (holder.motor)
        CHECK(c.frame().coordinates[0].motor == doctest::Approx(weight).epsilon(1e-4));
      if (holder.drive.motor.kind != MotorKind::position)
        CHECK(std::fabs(c.frame().coordinates[0].value) < 1e-5);
      CHECK(c.body(c.carrier).v.y() == doctest::Approx(rise).epsilon(1e-9));
    }
}

TEST_CASE("a brake that is just strong enough does not slip on a body that shakes") {
  // The load needs m A w^2 = 10 N at most.
  BodyCourse course;
  course.x[0] = over_time("0.2*(1 - cos(5*t))");
  CoordinateDrive brake, motor;
  brake.friction = 10.5;
  motor.motor.kind = MotorKind::velocity;
  motor.motor.max_force = 10.5;
  for (const char* stepper : {"realtime", "event"})
    for (const CoordinateDrive& drive : {brake, motor}) {
      INFO(std::string(stepper), " ", drive.friction);
      JointDef slider = of_kind(JointKind::prismatic, drive);
      slider.frame_a.q = slider.frame_b.q = axis_angle(Vec3::UnitY(), 0.5 * std::numbers::pi);
      Carried c(with(stepper), course, slider);
      double most = 0;
      for (int tick = 0; tick < 180; ++tick) {
        c.step();
        most = std::max(most, std::fabs(c.frame().coordinates[0].value));
      }
      CHECK(most < 1e-5);
      CHECK(std::fabs(c.frame().coordinates[0].rate) < 1e-5);
    }
}

TEST_CASE("a box rides on a table that shakes, as long as friction holds it") {
  // It needs a friction coefficient of A w^2 / g = 0.41. The tick that begins the motion is a jump
  // of the acceleration, in which any contact slips a little.
  for (const bool pile : {false, true}) {
    INFO(pile);
    TestWorld w(with("realtime"));
    BodyDef table = TestWorld::box_def({0, -0.1, 0}, {30, 0.1, 5});
    table.type = BodyType::kinematic;
    BodyCourse course;
    course.x[0] = over_time("0.16*(1 - cos(5*t))");
    table.course = std::make_shared<const BodyCourse>(course);
    table.shapes[0].material.friction = 0.45;
    const BodyId below = w.add(table);
    std::vector<BodyId> boxes;
    // Many boxes that touch each other are solved in single precision.
    for (int i = 0; i < (pile ? 40 : 1); ++i) {
      BodyDef box = TestWorld::box_def({i - 20.0, 0.5, 0}, {0.5, 0.5, 0.5});
      box.shapes[0].material.friction = 0.45;
      boxes.push_back(w.add(box));
    }
    w.run(2);
    for (size_t i = 0; i < boxes.size(); ++i)
      CHECK(std::fabs(w.body(boxes[i]).pose.x.x() - w.body(below).pose.x.x() - (double(i) - 20)) <
            2e-4);
  }
}

TEST_CASE("a motor on a turntable turns its load with I a") {
  BodyCourse turntable;
  turntable.axis = Vec3::UnitY();
  turntable.angle = over_time("2*t^2");
  for (const char* stepper : {"realtime", "event"})
    for (const Holder& holder : holders()) {
      INFO(std::string(stepper), " ", std::string(holder.name));
      CoordinateDrive drive = holder.drive;
      drive.motor.stiffness *= 0.1;
      drive.motor.damping *= 0.1;
      Carried c(with(stepper), turntable, of_kind(JointKind::revolute, drive));
      c.run(1);
      CHECK((c.frame().mean_force - Vec3(0, mass * g, 0)).norm() < 1e-6 * mass * g);
      CHECK((c.frame().mean_torque - Vec3(0, 4 * moment, 0)).norm() < 1e-3 * 4 * moment);
      if (holder.motor)
        CHECK(c.frame().coordinates[0].motor == doctest::Approx(4 * moment).epsilon(1e-3));
    }
}

TEST_CASE("friction that slips in a lift bears no more than it can") {
  // In the lift, s'' = f/m - (g + a).
  CoordinateDrive drive;
  drive.friction = 0.5 * mass * g;
  for (const char* stepper : {"realtime", "event"}) {
    INFO(stepper);
    Carried c(with(stepper), lift(), of_kind(JointKind::prismatic, drive));
    c.run(1);
    CHECK(c.frame().mean_force.y() == doctest::Approx(drive.friction).epsilon(1e-6));
    CHECK(c.frame().coordinates[0].value ==
          doctest::Approx(0.5 * (0.5 * g - (g + rise))).epsilon(1e-3));
  }
}

namespace {

/// Velocities of the bob's centre at ticks, relative to the axes of the world, for a pendulum of
/// length l whose pivot goes as A sin(w t) upwards, let go at angle `start`.
std::vector<Vec3> bob_velocities(double A, double w, double l, double start, int hz, int ticks) {
  constexpr int steps = 200;
  const double h = 1.0 / hz / steps, whole = moment + mass * l * l;
  // The pivot's start is a blow along y.
  double q = start, u = -mass * l * A * w * std::sin(start) / whole;
  const auto change = [&](double t, double angle) {
    return -mass * l * (g - A * w * w * std::sin(w * t)) * std::sin(angle) / whole;
  };
  std::vector<Vec3> out;
  for (int i = 0; i <= ticks * steps; ++i) {
    const double t = i * h;
    if (i % steps == 0)
      out.emplace_back(l * u * std::cos(q), A * w * std::cos(w * t) + l * u * std::sin(q), 0);
    const double k1 = change(t, q), u1 = u;
    const double u2 = u + 0.5 * h * k1, k2 = change(t + 0.5 * h, q + 0.5 * h * u1);
    const double u3 = u + 0.5 * h * k2, k3 = change(t + 0.5 * h, q + 0.5 * h * u2);
    const double u4 = u + h * k3, k4 = change(t + h, q + h * u3);
    q += h / 6 * (u1 + 2 * u2 + 2 * u3 + u4);
    u += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return out;
}

/// Greatest error of the mean force in the second half of a second, over the weight.
double pendulum_error(const char* stepper, int hz) {
  constexpr double A = 0.05, w = 12, l = 0.5, start = 0.8;
  BodyCourse course;
  course.x[1] = over_time("0.05*sin(12*t)");
  JointDef hinge = of_kind(JointKind::revolute);
  hinge.frame_a.q = hinge.frame_b.q = Quat::Identity();
  const Vec3 place(l * std::sin(start), -l * std::cos(start), 0);
  Carried c(with(stepper, hz), course, hinge, place);
  const std::vector<Vec3> v = bob_velocities(A, w, l, start, hz, hz);
  double most = 0;
  for (int tick = 0; tick < hz; ++tick) {
    const Vec3 before = c.body(c.load).v;
    c.step();
    const auto k = size_t(tick);
    const Vec3 weight(0, mass * g, 0);
    const Vec3 mean = c.frame().mean_force;
    // Whatever the motion is, what a tick's reaction and weight gave is its change of momentum.
    if (tick > 1)
      CHECK((mean - weight - mass * hz * (c.body(c.load).v - before)).norm() < 1e-6 * weight.y());
    CHECK(c.frame().mean_torque.z() == doctest::Approx(0).epsilon(1e-9));
    if (tick >= hz / 2)
      most = std::max(most, (mean - weight - mass * hz * (v[k + 1] - v[k])).norm() / weight.y());
  }
  return most;
}

}  // namespace

TEST_CASE("a pendulum on a pivot that shakes pulls as Lagrange's equation says") {
  // Under event too: where its acceleration changes sign a course is taken to be straight.
  for (const char* stepper : {"realtime", "event"}) {
    const double coarse = pendulum_error(stepper, 60), fine = pendulum_error(stepper, 240);
    INFO(std::string(stepper), " ", coarse, " ", fine);
    CHECK(coarse < 0.1);
    CHECK(fine < 0.4 * coarse);
  }
}

TEST_CASE("a ball joint bears no torque however fast its body swings") {
  for (const char* stepper : {"realtime", "event"}) {
    INFO(stepper);
    JointDef ball = of_kind(JointKind::spherical);
    ball.break_torque = 1e-6;
    TestWorld w(with(stepper));
    BodyDef d;
    d.mass = mass;
    d.inertia = Vec3::Constant(moment);
    d.pose.x = {0.5, 0, 0};
    d.velocity = {0, 10, 0};
    d.angular_velocity = {0, 0, 20};
    ball.b = w.add(d);
    ball.frame_b.x = -d.pose.x;
    REQUIRE(w->create_joint(ball).ok());
    w.run(1);
    CHECK(w->frame()->joints->size() == 1);
  }
}
