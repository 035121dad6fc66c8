// Free flight and free rotation. References: the parabola; conservation of angular momentum and
// energy; for the intermediate axis the number of flips, and for needles the orientation, from a
// Runge-Kutta solution of Euler's equations at 1e-4 s.
#include "engine/math/rotation.hpp"

#include "engine/dynamics/bodies/slender.hpp"
#include "engine/dynamics/realtime/integrate_bodies.hpp"
#include "tests/dynamics/rigid_world.hpp"

#include <cmath>

using namespace tumble;
using namespace tumble::test;

namespace {

Vec3 angular_momentum(const RigidBody& b) {
  return b.inertia_world() * b.omega;
}

/// Euler's equations about principal axes.
Vec3 euler(const Vec3& I, const Vec3& w) {
  return {(I.y() - I.z()) * w.y() * w.z() / I.x(), (I.z() - I.x()) * w.z() * w.x() / I.y(),
          (I.x() - I.y()) * w.x() * w.y() / I.z()};
}

}  // namespace

TEST_CASE("free flight is the parabola at any tick") {
  for (const double hz : {30.0, 60.0, 1000.0}) {
    RigidWorld w(hz);
    BodyDef d = body(sphere(0.1), {0, 100, 0});
    d.velocity = {3, 4, -5};
    w.add(d);
    w.run(2);
    const Vec3 want = Vec3(0, 100, 0) + 2 * d.velocity + 2 * w.gravity;
    CHECK((w.bodies[0].pose.x - want).norm() < 1e-10);
    CHECK((w.bodies[0].v - d.velocity - 2 * w.gravity).norm() < 1e-11);
  }
}

TEST_CASE("gravity_scale scales gravity") {
  RigidWorld w;
  BodyDef d = body(sphere(0.1), Vec3::Zero());
  d.gravity_scale = -0.5;
  w.add(d);
  w.run(1);
  CHECK(w.bodies[0].v.y() == doctest::Approx(0.5 * 9.81).epsilon(1e-12));
}

TEST_CASE("the intermediate axis flips as Euler's equations say, at constant L and nearly E (A6)") {
  RigidWorld w;
  w.gravity.setZero();
  w.settings.sleeping = false;
  // A box of 1 kg with moments 0.5, 1, 1.3.
  const Vec3 I(0.5, 1, 1.3);
  const double s = 0.5 * 12 * (I.x() + I.y() + I.z());
  BodyDef d = body(box(std::sqrt(s - 12 * I.x()) / 2, std::sqrt(s - 12 * I.y()) / 2,
                       std::sqrt(s - 12 * I.z()) / 2),
                   Vec3::Zero());
  d.mass = 1;
  d.angular_velocity = {0.01, 5, 0.01};
  w.add(d);
  const RigidBody& b = w.bodies[0];
  REQUIRE((b.inertia_body.diagonal() - I).norm() < 1e-12);
  const Vec3 L = angular_momentum(b);
  const double E = b.kinetic_energy();
  double worst_E = 0;
  int flips = 0, reference = 0;
  double side = 1;
  for (int k = 0; k < 3600; ++k) {
    w.step();
    worst_E = std::max(worst_E, std::abs(b.kinetic_energy() / E - 1));
    const double y = b.pose.inverse_direction(b.omega).y();
    if (std::abs(y) > 1 && y * side < 0) {
      ++flips;
      side = -side;
    }
  }
  Vec3 u = d.angular_velocity;
  side = 1;
  const double h = 1e-4;
  for (int k = 0; k < 600000; ++k) {
    const Vec3 k1 = euler(I, u), k2 = euler(I, u + h / 2 * k1), k3 = euler(I, u + h / 2 * k2),
               k4 = euler(I, u + h * k3);
    u += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    if (std::abs(u.y()) > 1 && u.y() * side < 0) {
      ++reference;
      side = -side;
    }
  }
  CHECK((angular_momentum(b) - L).norm() < 1e-10 * L.norm());
  CHECK(worst_E < 1e-3);
  CHECK(reference > 5);
  CHECK(flips == reference);
}

TEST_CASE("free rotation converges with second order") {
  RigidBody b = *make_body(body(box(0.1, 0.3, 0.2), Vec3::Zero()));
  const auto end = [&](int steps) {
    Quat q = Quat::Identity();
    Vec3 w(3, 2, -4);
    for (int k = 0; k < steps; ++k) rotate_freely(b, q, w, 1.0 / steps);
    return q;
  };
  const Quat exact = end(8000);
  const double coarse = end(100).angularDistance(exact);
  const double fine = end(200).angularDistance(exact);
  CHECK(coarse / fine > 3.7);
  CHECK(coarse / fine < 4.3);
}

TEST_CASE("torque and force act as their sums say") {
  RigidWorld w;
  w.gravity.setZero();
  w.add(body(box(0.5, 0.5, 0.5), Vec3::Zero()));
  w.before_step = [&] {
    w.bodies[0].force = {2000, 0, 0};
    w.bodies[0].torque = {0, 100, 0};
  };
  w.run(1);
  CHECK(w.bodies[0].v.x() == doctest::Approx(2).epsilon(1e-12));
  CHECK(w.bodies[0].omega.y() == doctest::Approx(100 * 6.0 / 1000).epsilon(1e-12));
}

TEST_CASE("spinning bodies neither gain nor lose energy, however fast") {
  for (const double speed : {50.0, 500.0, 6e4, 1e6}) {
    RigidWorld w;
    w.gravity.setZero();
    w.settings.sleeping = false;
    BodyDef d = body(box(0.2, 0.1, 0.05), Vec3::Zero());
    d.angular_velocity = speed * Vec3(1, 0.9, 0.8);
    w.add(d);
    const double before = w.bodies[0].kinetic_energy();
    w.run(1);
    CHECK(w.bodies[0].kinetic_energy() == doctest::Approx(before).epsilon(0.01));
  }
}

TEST_CASE("needles spin at any tick: energy and momentum stay, the axis goes where Euler says") {
  // Round and with a flat section, 1:200 and 1:30; about the long axis, across it, and both.
  const ShapeDef shapes[] = {cylinder(0.001, 0.2), capsule(0.004, 0.2), box(0.1, 0.0005, 0.001),
                             box(0.1, 0.002, 0.003)};
  for (const ShapeDef& shape : shapes) {
    for (const double hz : {30.0, 1000.0}) {
      for (const Vec3& spin : {Vec3(300, 400, 10), Vec3(3, 2000, 5), Vec3(5000, -4000, 8000)}) {
        RigidWorld w(hz);
        w.gravity.setZero();
        w.settings.sleeping = false;
        BodyDef d = body(shape, Vec3::Zero());
        d.angular_velocity = spin;
        w.add(d);
        const RigidBody& b = w.bodies[0];
        REQUIRE(slender_inertia(b.inertia_body));
        const double before = b.kinetic_energy();
        const Vec3 L = angular_momentum(b);
        w.run(1);
        CHECK(b.kinetic_energy() == doctest::Approx(before).epsilon(0.01));
        CHECK((angular_momentum(b) - L).norm() < 1e-9 * L.norm());
      }
    }
  }
}

TEST_CASE("a needle turns as a Runge-Kutta solution of Euler's equations says") {
  for (const ShapeDef& shape : {cylinder(0.02, 0.6), box(0.3, 0.02, 0.03)}) {
    const RigidBody needle = *make_body(body(shape, Vec3::Zero()));
    const Vec3 I = needle.inertia_body.diagonal();
    REQUIRE((needle.inertia_body - Mat3(I.asDiagonal())).norm() == 0);
    const auto inertia = slender_inertia(needle.inertia_body);
    REQUIRE(inertia);
    const Quat start = axis_angle({1, 2, 3}, 0.7);
    const Vec3 spin(3, 20, -4);
    const Vec3 L = start * (needle.inertia_body * (start.conjugate() * spin));
    Quat exact = start;
    Vec3 u = start.conjugate() * spin;
    const auto rate = [](const Quat& q, const Vec3& w) {
      return Vec4((q * Quat(0, 0.5 * w.x(), 0.5 * w.y(), 0.5 * w.z())).coeffs());
    };
    const auto moved = [](const Quat& q, const Vec4& d) {
      Quat out = q;
      out.coeffs() += d;
      return out;
    };
    const double h = 1e-4;
    for (int k = 0; k < 10000; ++k) {
      const Vec3 k1 = euler(I, u), u2 = u + h / 2 * k1, k2 = euler(I, u2), u3 = u + h / 2 * k2,
                 k3 = euler(I, u3), u4 = u + h * k3, k4 = euler(I, u4);
      const Vec4 r1 = rate(exact, u), r2 = rate(moved(exact, h / 2 * r1), u2),
                 r3 = rate(moved(exact, h / 2 * r2), u3), r4 = rate(moved(exact, h * r3), u4);
      exact = moved(exact, h / 6 * (r1 + 2 * r2 + 2 * r3 + r4)).normalized();
      u += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    const auto error = [&](int steps) {
      Quat q = start;
      for (int k = 0; k < steps; ++k) rotate_slender(*inertia, q, L, 1.0 / steps, 1);
      return q.angularDistance(exact);
    };
    if (shape.type == ShapeType::cylinder) {
      CHECK(error(1) < 1e-6);
    } else {
      CHECK(error(800) < 0.01);
      CHECK(error(800) / error(1600) == doctest::Approx(4).epsilon(0.1));
    }
  }
}
