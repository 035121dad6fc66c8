// Certificates of contacts. References: statics and Coulomb's law in closed form; Newton's second
// law for each body.
#include "engine/dynamics/event/certify.hpp"

#include "tests/dynamics/event_world.hpp"

#include <cmath>
#include <cstring>

using namespace tumble;
using namespace tumble::test;

namespace {

ContactCertificates certificates(EventWorld& w, std::string_view solver = "automatic") {
  const SmoothForces forces = [&](double, std::span<const uint32_t> slots) {
    for (const uint32_t s : slots) {
      RigidBody& b = w.bodies[s];
      b.force = b.mass * b.gravity_scale * w.gravity;
      b.torque.setZero();
    }
  };
  const auto method = contact_force_method(solver, "circular");
  REQUIRE(method.ok());
  auto out = certify(w.bodies, w.stepper.contacts, forces, *method);
  REQUIRE(out.ok());
  return *out;
}

}  // namespace

TEST_CASE("certify: a block on a slope says where it is in the cone, at rest and sliding") {
  for (const double slope : {0.2, 0.45, 0.8}) {
    EventWorld w;
    w.fixed(box(50, 1, 50), {0, -1, 0});
    w.add(body(box(0.5, 0.5, 0.5), {0, 0.5, 0}));
    const double theta = std::atan(slope), weight = 1000 * 9.81;
    w.gravity = {9.81 * std::sin(theta), -9.81 * std::cos(theta), 0};
    w.run(0.5);
    const ContactCertificates c = certificates(w);
    const bool slides = slope > 0.5;
    Vec3 sum = Vec3::Zero();
    double cone = 0;
    int closed = 0;
    for (const ContactCertificate& p : c.contacts) {
      if (p.mode == ContactMode::open) continue;
      ++closed;
      sum += p.force;
      cone = std::max(cone, p.place_in_cone);
      CHECK(p.mode == (slides ? ContactMode::sliding : ContactMode::sticking));
      CHECK(p.complementarity < 1e-9);
      CHECK(p.residual < 1e-9);
      CHECK(p.solver == "cone_newton");
      CHECK(std::fabs(p.gap) < 1e-8);
      CHECK(std::fabs(p.normal_velocity) < 1e-9);
      const double a = slides ? 9.81 * (std::sin(theta) - 0.5 * std::cos(theta)) : 0;
      CHECK((p.slip_acceleration - Vec3(a, 0, 0)).norm() < 1e-8);
      CHECK((p.slip_velocity - Vec3(0.5 * a, 0, 0)).norm() < 1e-8);
    }
    CHECK(closed == 4);
    CHECK(cone <= 1 + 1e-9);
    if (slides) CHECK(cone > 1 - 1e-9);
    const double down = slides ? 0.5 * std::cos(theta) : std::sin(theta);
    CHECK((sum - weight * Vec3(-down, std::cos(theta), 0)).norm() < 1e-8 * weight);
    REQUIRE(c.bodies.size() == 1);
    CHECK(c.bodies[0].residual < 1e-9);
    CHECK((c.bodies[0].contact_force - sum).norm() == 0);
  }
}

TEST_CASE("certify: bodies of a tower balance, and stay as they were to the bit") {
  EventWorld w;
  w.floor();
  for (int i = 0; i < 6; ++i)
    w.add(body(box(0.5, 0.5, 0.5), {0.05 * (i % 3), 0.5 + i, 0.02 * (i % 2)}));
  w.add(body(sphere(0.5), {5, 3, 0}));
  w.run(0.1);
  const std::vector<RigidBody> before = w.bodies;
  const ContactCertificates c = certificates(w);
  REQUIRE(c.bodies.size() == 7);
  for (const BodyBalance& b : c.bodies) {
    CHECK(b.residual < 1e-9);
    const double up = b.body == 7 ? 0 : 1000 * 9.81;
    CHECK((b.contact_force - Vec3(0, up, 0)).norm() < 1e-8 * 9810);
  }
  for (size_t i = 0; i < before.size(); ++i) {
    CHECK(w.bodies[i].pose.x == before[i].pose.x);
    CHECK(w.bodies[i].pose.q.coeffs() == before[i].pose.q.coeffs());
    CHECK(w.bodies[i].v == before[i].v);
    CHECK(w.bodies[i].omega == before[i].omega);
  }
  for (const char* solver : {"baraff", "pgs", "cone_newton"}) {
    const ContactCertificates other = certificates(w, solver);
    for (size_t i = 0; i < c.bodies.size(); ++i)
      CHECK((other.bodies[i].contact_force - c.bodies[i].contact_force).norm() < 1e-6 * 9810);
  }
}

TEST_CASE("certify: a table on four legs presses as statics of least norm says") {
  for (const double offset : {0.0, 0.12}) {
    EventWorld w;
    w.floor();
    BodyDef table = body(box(0.6, 0.05, 0.4), {0, 0.75, 0});
    for (const double x : {-0.55, 0.55})
      for (const double z : {-0.35, 0.35}) {
        table.shapes.push_back(table.shapes[0]);
        table.shapes.back().shape = sphere(0.05);
        table.shapes.back().pose.x = {x, -0.7, z};
      }
    const uint32_t t = w.add(table);
    BodyDef load = body(box(0.1, 0.1, 0.1), {offset, 0.9, 0});
    load.mass = 20;
    w.add(load);
    w.run(0.5);
    const ContactCertificates c = certificates(w);
    const double weight = w.bodies[t].mass * 9.81, more = 20 * 9.81;
    int legs = 0;
    for (const ContactCertificate& p : c.contacts) {
      if (p.key.body_a != 0 || p.mode == ContactMode::open) continue;
      ++legs;
      const double want = (weight + more * (1 + offset * p.x_world.x() / (0.55 * 0.55))) / 4;
      CHECK(p.normal.dot(p.force) == doctest::Approx(want).epsilon(1e-8));
    }
    CHECK(legs == 4);
  }
}
