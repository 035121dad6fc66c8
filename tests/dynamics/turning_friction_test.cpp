// Rolling and torsional friction of the realtime stepper. References: Coulomb's law of rolling
// friction in closed form (a ball that rolls without slip slows down by 5/7 rho g / r and rests on
// slopes up to tan = rho / r, one that spins on a point stops after 2 r^2 w / (5 tau g)), by the
// scalar rows as small groups are solved and by the bundles of large ones; conservation of
// momentum.
#include "engine/dynamics/contact/cached_pair.hpp"
#include "engine/dynamics/contact/pair_side.hpp"
#include "engine/math/rotation.hpp"
#include "tests/dynamics/rigid_world.hpp"

#include <cmath>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double g = 9.81;
constexpr double radius = 0.25;

/// A floor and bodies of one material. `bundled` has islands solved in bundles however small they
/// are, with as many sub-steps as the scalar rows take.
class TurningWorld : public RigidWorld {
 public:
  TurningWorld(double rolling, double torsional, bool bundled, double hz = 60) : RigidWorld(hz) {
    settings.sleeping = false;
    if (bundled) settings.substeps = settings.max_substeps;
    material.friction = 0.8;
    material.rolling_friction = rolling;
    material.torsional_friction = torsional;
    floor();
    bodies[0].shapes[0].material = material;
  }
  uint32_t put(BodyDef d) {
    d.shapes[0].material = material;
    return add(d);
  }
  /// Gravity tilted downhill along x by a slope of this tangent.
  void tilt(double tangent) {
    const double theta = std::atan(tangent);
    gravity = g * Vec3(std::sin(theta), -std::cos(theta), 0);
  }
  Material material;
};

BodyDef rolling_ball(double speed, double heading, double z = 0) {
  BodyDef d = body(sphere(radius), {0, radius, z});
  d.velocity = speed * Vec3(std::cos(heading), 0, std::sin(heading));
  d.angular_velocity = Vec3::UnitY().cross(d.velocity) / radius;
  return d;
}

}  // namespace

TEST_CASE(
    "a rolling ball slows down by 5/7 rho g / r in every direction, and stays where it stops") {
  const double rho = 0.02, speed = 1.2;
  const double slowing = 5.0 / 7 * rho * g / radius;
  for (const bool bundled : {false, true}) {
    for (const double heading : {0.0, 0.7, 2.5}) {
      CAPTURE(bundled);
      CAPTURE(heading);
      TurningWorld w(rho, 0, bundled);
      const uint32_t i = w.put(rolling_ball(speed, heading));
      w.run(1);
      CHECK(w.bodies[i].v.norm() == doctest::Approx(speed - slowing).epsilon(2e-3));
      w.run(2.5);
      const Vec3 moved = w.bodies[i].pose.x - Vec3(0, radius, 0);
      CHECK(moved.norm() == doctest::Approx(speed * speed / (2 * slowing)).epsilon(5e-3));
      CHECK(std::atan2(moved.z(), moved.x()) == doctest::Approx(heading).epsilon(1e-3));
      CHECK(w.bodies[i].v.norm() < 1e-6);
      CHECK(w.bodies[i].omega.norm() < 1e-5);
    }
  }
}

TEST_CASE("a ball rests on slopes up to tan = rho / r and rolls down steeper ones as they say") {
  const double rho = 0.025, limit = rho / radius;
  for (const bool bundled : {false, true}) {
    for (const double share : {0.5, 0.98, 1.02, 2.0}) {
      CAPTURE(bundled);
      CAPTURE(share);
      TurningWorld w(rho, 0, bundled);
      w.tilt(share * limit);
      const uint32_t i = w.put(rolling_ball(0, 0));
      w.run(0.5);  // until it has sunk in
      const Vec3 x = w.bodies[i].pose.x, v = w.bodies[i].v;
      w.run(3);
      const double moved = w.bodies[i].pose.x.x() - x.x();
      if (share < 1) {
        CHECK(std::abs(moved) < 1e-4);
      } else {
        const double a = 5.0 / 7 * (w.gravity.x() + rho / radius * w.gravity.y());
        CHECK(w.bodies[i].v.x() - v.x() == doctest::Approx(3 * a).epsilon(5e-3));
        CHECK(moved == doctest::Approx(3 * v.x() + 4.5 * a).epsilon(5e-3));
      }
    }
  }
}

TEST_CASE("a ball that spins on a point stops after 2 r^2 w / (5 tau g), whatever its friction") {
  const double tau = 0.004, spin = 6;
  const double takes = 2 * radius * radius * spin / (5 * tau * g);
  for (const bool bundled : {false, true}) {
    for (const double friction : {0.0, 0.8}) {
      CAPTURE(bundled);
      CAPTURE(friction);
      TurningWorld w(0, tau, bundled);
      w.material.friction = w.bodies[0].shapes[0].material.friction = friction;
      BodyDef d = rolling_ball(0, 0);
      d.angular_velocity = {0, spin, 0};
      const uint32_t i = w.put(d);
      w.run(0.5 * takes);
      const double still = spin - tau * g * double(w.ticks) * w.h / (0.4 * radius * radius);
      CHECK(w.bodies[i].omega.y() == doctest::Approx(still).epsilon(2e-3));
      w.run(0.48 * takes);
      CHECK(w.bodies[i].omega.y() > 0);
      w.run(0.05 * takes + 0.05);
      CHECK(w.bodies[i].omega.norm() < 1e-5);
    }
  }
}

TEST_CASE("rolling and torsional friction lose nothing while a body sinks in, at any tick") {
  // A contact takes its load only as the body sinks in, over 1 / (w^2 hs) seconds of weight: at 960
  // Hz 1.3 % of half a second.
  const double rho = 0.02, tau = 0.004, speed = 3, spin = 9, seconds = 0.5;
  const double slowing = 5.0 / 7 * rho * g / radius, braking = tau * g / (0.4 * radius * radius);
  for (const bool bundled : {false, true}) {
    for (const double hz : {60.0, 240.0, 960.0}) {
      CAPTURE(bundled);
      CAPTURE(hz);
      TurningWorld w(rho, tau, bundled, hz);
      if (bundled) w.settings.substeps = w.settings.max_substeps = 4;
      const uint32_t rolls = w.put(rolling_ball(speed, 0.3));
      BodyDef d = rolling_ball(0, 0, 5);
      d.angular_velocity = {0, spin, 0};
      const uint32_t spins = w.put(d);
      w.run(seconds);
      const double digits = bundled ? 1e-3 : 1e-5;  // what a sub-step takes, of single precision
      CHECK((speed - w.bodies[rolls].v.norm()) / (slowing * seconds) ==
            doctest::Approx(1).epsilon(digits));
      CHECK((spin - w.bodies[spins].omega.y()) / (braking * seconds) ==
            doctest::Approx(1).epsilon(digits));
    }
  }
}

TEST_CASE("a disc that spins flat resists by the friction of its points, not by a lever arm") {
  const double r = 0.3, spin = 5;
  const auto spin_after = [&](double torsional, bool bundled, double friction) {
    TurningWorld w(0.01, torsional, bundled);
    w.material.friction = w.bodies[0].shapes[0].material.friction = friction;
    BodyDef d = body(cylinder(r, 0.05), {0, 0.025, 0});
    const uint32_t i = w.put(d);
    w.run(0.2);
    w.bodies[i].omega = {0, spin, 0};
    w.run(0.5);
    return w.bodies[i].omega.y();
  };
  for (const bool bundled : {false, true}) {
    CAPTURE(bundled);
    CHECK(spin_after(0.01, bundled, 0) == doctest::Approx(spin).epsilon(1e-6));
    CHECK(spin_after(0.01, bundled, 0.02) ==
          doctest::Approx(spin_after(0, bundled, 0.02)).epsilon(1e-5));
    // Its points lie on the rim: mu N r on the moment m r^2 / 2.
    const double slowing = 2 * 0.02 * g / r;
    CHECK(spin_after(0.01, bundled, 0.02) == doctest::Approx(spin - 0.5 * slowing).epsilon(5e-3));
  }
}

TEST_CASE("a cylinder rolls out with 2/3 rho g / r on its line of contact") {
  const double rho = 0.02, speed = 1.2, slowing = 2.0 / 3 * rho * g / radius;
  for (const bool bundled : {false, true}) {
    CAPTURE(bundled);
    TurningWorld w(rho, 0, bundled);
    BodyDef d = body(cylinder(radius, 0.4), {0, radius, 0});
    d.pose.q = axis_angle(Vec3::UnitX(), M_PI / 2);
    d.velocity = {speed, 0, 0};
    d.angular_velocity = {0, 0, -speed / radius};
    const uint32_t i = w.put(d);
    w.run(1);
    CHECK(w.bodies[i].v.x() == doctest::Approx(speed - slowing).epsilon(5e-3));
    w.run(2);
    CHECK(w.bodies[i].v.norm() < 1e-6);
  }
}

TEST_CASE("of two materials the root of the product counts: one that has none has the last word") {
  PairSide a, b;
  a.rolling_friction = 0.002;
  b.rolling_friction = 0.008;
  a.torsional_friction = 0.01;
  b.torsional_friction = 0;
  Contact contact;
  take_materials(contact, a, b);
  CHECK(contact.rolling_friction == doctest::Approx(0.004).epsilon(1e-15));
  CHECK(contact.torsional_friction == 0);
}

TEST_CASE("what resists turning between bodies changes no momentum of theirs") {
  for (const bool bundled : {false, true}) {
    CAPTURE(bundled);
    TurningWorld w(0.03, 0.02, bundled);
    w.gravity.setZero();
    BodyDef a = body(sphere(0.3), {0, 3, 0}), b = body(sphere(0.2), {0.48, 3, 0.1});
    a.velocity = {1, 0, 0};
    b.velocity = {-1, 0.3, 0};
    a.angular_velocity = {2, 1, 5};
    b.angular_velocity = {-3, 4, 1};
    const uint32_t i = w.put(a), j = w.put(b);
    const auto angular = [&] {
      Vec3 L = Vec3::Zero();
      for (const uint32_t k : {i, j}) {
        const RigidBody& x = w.bodies[k];
        L += x.mass * x.pose.x.cross(x.v) + x.inertia_world() * x.omega;
      }
      return L;
    };
    const Vec3 P = w.momentum(), L = angular();
    const double scale = w.bodies[i].mass * 3;
    const Vec3 apart = w.bodies[i].omega - w.bodies[j].omega;
    w.run(0.1);
    CHECK((w.bodies[i].omega - w.bodies[j].omega - apart).norm() > 1);
    CHECK((w.momentum() - P).norm() < 1e-6 * scale);
    CHECK((angular() - L).norm() < 5e-3 * scale);
  }
}
