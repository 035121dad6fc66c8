// Rolling and torsional friction of the event stepper. References: Coulomb's law of rolling
// friction in closed form (a ball that rolls without slip slows down by 5/7 rho g / r and rests on
// slopes up to tan = rho / r, one that spins on a point stops after 2 r^2 w / (5 tau g), a cylinder
// rolls out with 2/3 rho g / r), its equation of motion integrated by itself, conservation of
// momentum, the balance of every body, and the realtime stepper.
#include "engine/dynamics/event/certify.hpp"
#include "engine/math/rotation.hpp"
#include "tests/dynamics/event_world.hpp"

#include <cmath>
#include <optional>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double g = 9.81;
constexpr double radius = 0.25;

/// Bodies and a floor of one material.
template <class World>
class OfMaterial : public World {
 public:
  OfMaterial(std::optional<double> rolling, std::optional<double> torsional,
             double friction = 0.8) {
    material.friction = friction;
    material.rolling_friction = rolling;
    material.torsional_friction = torsional;
    this->floor();
    this->bodies[0].shapes[0].material = material;
  }
  uint32_t put(BodyDef d) {
    d.shapes[0].material = material;
    return this->add(d);
  }
  void tilt(double tangent) {
    const double theta = std::atan(tangent);
    this->gravity = g * Vec3(std::sin(theta), -std::cos(theta), 0);
  }
  Material material;
};
using EventTurningWorld = OfMaterial<EventWorld>;

BodyDef rolling_ball(double speed, double heading) {
  BodyDef d = body(sphere(radius), {0, radius, 0});
  d.velocity = speed * Vec3(std::cos(heading), 0, std::sin(heading));
  d.angular_velocity = Vec3::UnitY().cross(d.velocity) / radius;
  return d;
}

}  // namespace

TEST_CASE("event: a rolling ball slows down by 5/7 rho g / r and stays where it stops") {
  const double rho = 0.02, speed = 1.2, slowing = 5.0 / 7 * rho * g / radius;
  for (const double heading : {0.0, 0.7, 2.5}) {
    CAPTURE(heading);
    EventTurningWorld w(rho, 0);
    const uint32_t i = w.put(rolling_ball(speed, heading));
    w.run(1);
    CHECK(w.bodies[i].v.norm() == doctest::Approx(speed - slowing).epsilon(1e-9));
    w.run(2.5);
    const Vec3 moved = w.bodies[i].pose.x - Vec3(0, radius, 0);
    CHECK(moved.norm() == doctest::Approx(speed * speed / (2 * slowing)).epsilon(1e-9));
    CHECK(std::atan2(moved.z(), moved.x()) == doctest::Approx(heading).epsilon(1e-9));
    CHECK(w.bodies[i].v.norm() < 1e-12);
    CHECK(w.bodies[i].omega.norm() < 1e-12);
  }
}

TEST_CASE("event: a ball rests on slopes up to tan = rho / r and rolls down steeper ones") {
  const double rho = 0.025, limit = rho / radius;
  for (const double share : {0.5, 0.999, 1.001, 2.0}) {
    CAPTURE(share);
    EventTurningWorld w(rho, 0);
    w.tilt(share * limit);
    const uint32_t i = w.put(rolling_ball(0, 0));
    w.run(2);
    const double a = 5.0 / 7 * (w.gravity.x() + rho / radius * w.gravity.y());
    CHECK(std::fabs(w.bodies[i].pose.x.x() - (share < 1 ? 0 : 2 * a)) < 1e-9);
    CHECK(std::fabs(w.bodies[i].v.x() - (share < 1 ? 0 : 2 * a)) < 1e-9);
  }
}

TEST_CASE("event: a ball that rolls up a slope comes back as the steeper slope says") {
  const double rho = 0.025;
  EventTurningWorld w(rho, 0);
  w.tilt(0.2);
  const uint32_t i = w.put(rolling_ball(-1, 0));
  const double push = w.gravity.x(), brake = -rho / radius * w.gravity.y();
  const double up = 5.0 / 7 * (push + brake), down = 5.0 / 7 * (push - brake);
  const double turns = 1 / up, left = 1.5 - turns;
  w.run(1.5);
  CHECK(w.bodies[i].v.x() == doctest::Approx(down * left).epsilon(1e-9));
  CHECK(w.bodies[i].pose.x.x() ==
        doctest::Approx(-0.5 / up + 0.5 * down * left * left).epsilon(1e-9));
}

TEST_CASE("event: a ball that spins on a point stops after 2 r^2 w / (5 tau g)") {
  const double tau = 0.004, spin = 6, takes = 2 * radius * radius * spin / (5 * tau * g);
  for (const double friction : {0.0, 0.8}) {
    CAPTURE(friction);
    EventTurningWorld w(0, tau, friction);
    BodyDef d = rolling_ball(0, 0);
    d.angular_velocity = {0, spin, 0};
    const uint32_t i = w.put(d);
    w.run(0.9 * takes);
    const double still = spin - tau * g * double(w.ticks) * w.h / (0.4 * radius * radius);
    CHECK(w.bodies[i].omega.y() == doctest::Approx(still).epsilon(1e-9));
    w.run(0.2 * takes);
    CHECK(w.bodies[i].omega.norm() < 1e-12);
  }
}

TEST_CASE("event: a cylinder rolls out with 2/3 rho g / r on its line") {
  const double rho = 0.02, speed = 1.2, slowing = 2.0 / 3 * rho * g / radius;
  EventTurningWorld w(rho, 0);
  BodyDef d = body(cylinder(radius, 0.4), {0, radius, 0});
  d.pose.q = axis_angle(Vec3::UnitX(), M_PI / 2);
  d.velocity = {speed, 0, 0};
  d.angular_velocity = {0, 0, -speed / radius};
  const uint32_t i = w.put(d);
  w.run(1);
  CHECK(w.bodies[i].v.x() == doctest::Approx(speed - slowing).epsilon(1e-7));
  w.run(2);
  CHECK(w.bodies[i].v.norm() < 1e-9);
  CHECK(w.bodies[i].pose.x.x() == doctest::Approx(speed * speed / (2 * slowing)).epsilon(1e-7));
}

TEST_CASE("event: a cylinder rests on slopes up to tan = rho / r and rolls down steeper ones") {
  const double rho = 0.025, limit = rho / radius;
  for (const double share : {0.9, 1.1}) {
    CAPTURE(share);
    EventTurningWorld w(rho, 0);
    w.tilt(share * limit);
    BodyDef d = body(cylinder(radius, 0.4), {0, radius, 0});
    d.pose.q = axis_angle(Vec3::UnitX(), M_PI / 2);
    const uint32_t i = w.put(d);
    w.run(1);
    const double a = 2.0 / 3 * (w.gravity.x() + rho / radius * w.gravity.y());
    CHECK(std::fabs(w.bodies[i].v.x() - (share < 1 ? 0 : a)) < 1e-7);
  }
}

TEST_CASE("event: across a slope the path is that of the equation of motion") {
  // v' = 5/7 (g_along - rho / r g_across v / |v|), by the midpoint rule in 1e5 steps.
  const double rho = 0.02;
  const auto end_of = [&](auto& w) {
    w.tilt(0.15);
    const uint32_t i = w.put(rolling_ball(0.4, M_PI / 2));
    w.run(1);
    return w.bodies[i].pose.x;
  };
  EventTurningWorld exact(rho, 0);
  const Vec3 found = end_of(exact);
  Vec3 x(0, radius, 0), v(0, 0, 0.4);
  const auto rate = [&](const Vec3& u) {
    return Vec3(
        5.0 / 7 *
        (Vec3(exact.gravity.x(), 0, 0) + rho / radius * exact.gravity.y() * u.normalized()));
  };
  const int n = 100000;
  for (int k = 0; k < n; ++k) {
    const Vec3 mid = v + 0.5 / n * rate(v);
    x += mid / n;
    v += rate(mid) / n;
  }
  CHECK((found - x).norm() < 1e-7);
  OfMaterial<RigidWorld> rough(rho, 0);
  rough.settings.sleeping = false;
  CHECK((end_of(rough) - x).norm() < 1e-3);
}

TEST_CASE("event: what rolls off sideways from almost none does not hang or blow up") {
  EventTurningWorld w(0.02, 0.001);
  w.tilt(0.1);
  BodyDef d = rolling_ball(1e-4, M_PI / 2);
  const uint32_t i = w.put(d);
  w.run(1);
  CHECK(w.events < 200);
  CHECK(std::fabs(w.bodies[i].v.z()) < 1e-4);
}

TEST_CASE("event: two balls that touch and turn keep their momentum") {
  EventTurningWorld w(0.03, 0.02);
  w.gravity.setZero();
  BodyDef a = body(sphere(0.3), {0, 3, 0}), b = body(sphere(0.2), {0.5, 3, 0});
  a.angular_velocity = {2, 1, 5};
  b.angular_velocity = {-3, 4, 1};
  const uint32_t i = w.put(a), j = w.put(b);
  // Along the line of centres, so that it has no moment.
  w.extra_force = [&](uint32_t s, RigidBody& x) {
    if (s == i || s == j) x.force += 40 * (w.bodies[s == i ? j : i].pose.x - x.pose.x).normalized();
  };
  const auto angular = [&] {
    Vec3 L = Vec3::Zero();
    for (const uint32_t k : {i, j}) {
      const RigidBody& x = w.bodies[k];
      L += x.mass * x.pose.x.cross(x.v) + x.inertia_world() * x.omega;
    }
    return L;
  };
  const Vec3 L = angular(), apart = w.bodies[i].omega - w.bodies[j].omega;
  w.run(0.05);
  CHECK((w.bodies[i].omega - w.bodies[j].omega - apart).norm() > 1e-3);
  CHECK((angular() - L).norm() < 1e-9 * w.bodies[i].mass);
}

TEST_CASE("event: values that nobody gives are none, those given act, the default's too") {
  const auto lost = [](std::optional<double> rolling) {
    EventTurningWorld w(rolling, rolling);
    const uint32_t i = w.put(rolling_ball(1, 0));
    w.run(0.5);
    return 1 - w.bodies[i].v.norm();
  };
  CHECK(std::fabs(lost({})) < 1e-9);
  for (const double rolling : {1e-4, default_turning_friction})
    CHECK(lost(rolling) == doctest::Approx(0.5 * 5.0 / 7 * rolling * g / radius).epsilon(1e-6));
}

TEST_CASE("event: a disc that lies flat resists turning by its points, not by a lever arm") {
  EventTurningWorld w(0.01, 0.01, 0);
  const uint32_t i = w.put(body(cylinder(0.3, 0.05), {0, 0.025, 0}));
  w.bodies[i].omega = {0, 5, 0};
  w.run(0.2);
  CHECK(w.bodies[i].omega.y() == doctest::Approx(5).epsilon(1e-9));
}

TEST_CASE("event: certificates of what rolls, spins or is held balance with the torques") {
  for (const double speed : {0.0, 0.5}) {
    CAPTURE(speed);
    EventTurningWorld w(0.03, 0.01);
    w.tilt(0.05);
    BodyDef d = rolling_ball(speed, 0.4);
    d.angular_velocity.y() += speed;
    const uint32_t i = w.put(d);
    w.run(0.1);
    const SmoothForces forces = [&](double, std::span<const uint32_t> slots) {
      for (const uint32_t s : slots) w.bodies[s].force = w.bodies[s].mass * w.gravity;
    };
    const auto method = contact_force_method("automatic", "circular");
    const auto found = certify(w.bodies, w.stepper.contacts, forces, *method);
    REQUIRE(found.ok());
    REQUIRE(found->bodies.size() == 1);
    const BodyBalance& ball = found->bodies[0];
    CHECK(ball.residual < 1e-9);
    for (const ContactCertificate& c : found->contacts) CHECK(c.residual < 1e-9);
    // What resists is the moment of friction less the torque, no more than the arms allow.
    const double m = w.bodies[i].mass, press = -m * w.gravity.y();
    const Vec3 arm(0, -radius, 0);
    const Vec3 torque = ball.contact_torque - arm.cross(ball.contact_force);
    CHECK(std::hypot(torque.x(), torque.z()) <= 0.03 * press * (1 + 1e-9));
    CHECK(std::fabs(torque.y()) <= 0.01 * press * (1 + 1e-9));
    if (speed > 0) {
      CHECK(std::hypot(torque.x(), torque.z()) == doctest::Approx(0.03 * press).epsilon(1e-6));
      CHECK(torque.y() == doctest::Approx(-0.01 * press).epsilon(1e-6));
    } else {
      CHECK(torque.z() == doctest::Approx(m * w.gravity.x() * radius).epsilon(1e-6));
    }
  }
}
