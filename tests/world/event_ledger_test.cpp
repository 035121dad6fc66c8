// The books of the event stepper. References: closed forms (Kepler's energy, (1 - e^2) m g h of a
// bounce, m v^2 / 2 of what slides to rest) and the order of Runge-Kutta's fourth-order method.
#include "tests/support/test_world.hpp"

#include <array>
#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;
using test::TestWorld;

namespace {

WorldSettings event_books(int hz, const Vec3& gravity = {0, -9.81, 0}) {
  WorldSettings s;
  s.tick.num = hz;
  s.gravity = gravity;
  s.stepper = "event";
  s.event.integrator = "rk4";
  return s;
}

LedgerEntry line_total(TestWorld& w, LedgerLine line) {
  return w->frame()->ledger->line(line).total();
}

/// An eccentric orbit with drag, a damped spring and wind, for a second.
double smooth_drift(int hz) {
  TestWorld w(event_books(hz));
  const BodyId ball = w.sphere({1, 0, 0}, 0.1);
  REQUIRE(w->set_velocity(ball, {0, 1, -2}, {1, 2, 3}).ok());
  PointGravityDef sun;
  sun.mu = 4;
  sun.softening = 0.3;
  w.force(sun);
  w.force(LinearDragDef{0.4, 0.2});
  SpringDef spring;
  spring.a.point = Vec3(0, 1.5, 0);
  spring.b = {Anchor::Kind::body, ball, {}, 0, Vec3(0, 0.05, 0)};
  spring.stiffness = 20 * w.body(ball).mass;
  spring.damping = 0.5 * w.body(ball).mass;
  w.force(spring);
  VortexDef vortex;
  vortex.circulation = 3;
  w.force(vortex);
  w.run(1);
  for (size_t i = 1; i < 4; ++i)
    if (i != 2) CHECK(w->frame()->ledger->forces()[i].account.total().balance != 0);
  CHECK(w->frame()->ledger->forces()[0].account.total().balance == 0);
  CHECK(w->frame()->ledger->forces()[2].account.total().balance < 0);
  return w->frame()->ledger->drift();
}

}  // namespace

TEST_CASE("event: the integrator's error in the books is of fourth order with rk4, and tiny") {
  const std::array<double, 3> drift{smooth_drift(50), smooth_drift(100), smooth_drift(200)};
  CHECK(smooth_drift(400) < 1e-9);
  CHECK(std::log2(drift[0] / drift[1]) > 3.7);
  CHECK(std::log2(drift[1] / drift[2]) > 3.7);
}

TEST_CASE("event: bounces take 1 - e^2 of the energy, each, and the books show it") {
  TestWorld w(event_books(60));
  BodyDef ground = TestWorld::box_def({0, -1, 0}, {5, 1, 5});
  ground.type = BodyType::fixed;
  ground.shapes[0].material.friction = 0;
  w.add(ground);
  BodyDef ball = TestWorld::sphere_def({0, 2.3, 0}, 0.3);
  ball.shapes[0].material.restitution = 0.8;
  ball.shapes[0].material.friction = 0;
  const BodyId id = w.add(ball);
  w.run(1.5);  // it lands after 0.64 and 1.66 s
  const double m = w.body(id).mass;
  CHECK(line_total(w, LedgerLine::restitution).balance ==
        doctest::Approx(-(1 - 0.64) * m * 9.81 * 2).epsilon(1e-6));
  CHECK(w->frame()->ledger->drift() < 1e-9);
}

TEST_CASE("event: sliding to rest, friction takes the energy of motion and the momentum") {
  TestWorld w(event_books(120));
  BodyDef ground = TestWorld::box_def({0, -1, 0}, {50, 1, 5});
  ground.type = BodyType::fixed;
  ground.shapes[0].material.friction = 0.4;
  w.add(ground);
  BodyDef def = TestWorld::box_def({0, 0.25, 0}, {0.5, 0.25, 0.5});
  def.shapes[0].material.friction = 0.4;
  def.velocity = Vec3(2, 0, 0);
  const BodyId box = w.add(def);
  w.run(1);
  const double m = w.body(box).mass;
  CHECK(w.body(box).v.norm() < 1e-6);
  const LedgerEntry friction = line_total(w, LedgerLine::friction);
  CHECK(friction.balance == doctest::Approx(-0.5 * m * 4).epsilon(1e-6));
  CHECK(friction.momentum.x() == doctest::Approx(-2 * m).epsilon(1e-6));
  CHECK(w->frame()->ledger->drift() < 1e-6);
}
