// The event stepper. References: closed forms (rolling, Zeno's series, two impacts), conservation
// laws. The accuracy cases A1 to A10 are in tests/world/accuracy_test.cpp and beside it.
#include "engine/math/ode/integrator.hpp"
#include "tests/dynamics/event_world.hpp"

#include <cmath>

using namespace tumble;
using namespace tumble::test;

TEST_CASE("event: a ball with backspin slides, turns and rolls as the closed form says") {
  EventWorld w;
  w.floor(0.3);
  BodyDef d = body(sphere(0.2), {0, 0.2, 0}, 0.3);
  d.velocity = {1, 0, 0};
  d.angular_velocity = {0, 0, 10};
  w.add(d);
  // slip 1 + 0.2 * 10 = 3 m/s; it ends at t = (2/7) 3 / (mu g); then v = 1 - mu g t rolls.
  const double t = 2.0 / 7 * 3 / (0.3 * 9.81), v = 1 - 0.3 * 9.81 * t;
  w.run(2);
  CHECK(w.bodies[1].v.x() == doctest::Approx(v).epsilon(1e-9));
  CHECK(w.bodies[1].omega.z() == doctest::Approx(-v / 0.2).epsilon(1e-9));
  CHECK(w.bodies[1].pose.x.x() ==
        doctest::Approx(t - 0.5 * 0.3 * 9.81 * t * t + v * (2 - t)).epsilon(1e-8));
}

TEST_CASE("event: what slides slowly slides straight on, though its friction is stiff") {
  // Where friction turns the slip a hundred times in a step a turn of 1e-16 rad must not grow.
  const double slope = std::atan(0.5) + 0.1 * 3.14159265358979 / 180;
  const double acceleration = 9.81 * (std::sin(slope) - 0.5 * std::cos(slope));
  for (const double turn : {0.0, 0.3}) {
    CAPTURE(turn);
    EventWorld w;
    w.gravity = 9.81 * Vec3(std::sin(slope) * std::cos(turn), -std::cos(slope),
                            std::sin(slope) * std::sin(turn));
    w.floor(0.5);
    w.add(body(box(0.25, 0.12, 0.2), {0, 0.12, 0}, 0.5));
    w.run(3);
    const Vec3 along(std::cos(turn), 0, std::sin(turn));
    CHECK((w.bodies[1].v - 3 * acceleration * along).norm() < 1e-9);
    CHECK(w.bodies[1].omega.norm() < 1e-9);
  }
}

TEST_CASE("event: bounces with restitution come to rest at Zeno's time") {
  EventWorld w;
  w.floor(0, 0.5);
  w.add(body(sphere(0.1), {0, 1.1, 0}, 0, 0.5));
  // t = sqrt(2 d / g) (1 + 2 e / (1 - e))
  const double end = std::sqrt(2 / 9.81) * 3;
  while (w.ticks * w.h < end + w.h) w.step();
  CHECK(std::fabs(w.bodies[1].pose.x.y() - 0.1) < 1e-8);
  CHECK(w.bodies[1].v.norm() < 1e-8);
}

TEST_CASE(
    "event: bounces on a plate that sweeps round end below what rounding tells, and no later") {
  // A ball that slides outward along a turning plate is pressed on it by 2 omega s', far more than
  // by any gravity: hops become lower than the last digits of a place. The way along the plate
  // is that of a bead: s'' = omega^2 s.
  constexpr double turn = 100, s0 = 0.05, speed = 10, thick = 0.01, r = 0.02, time = 0.01;
  for (const double far : {0.0, 30.0, 1000.0})
    for (const double e : {0.0, 0.1, 0.3, 0.5}) {
      CAPTURE(far);
      CAPTURE(e);
      EventWorld w(1000);
      w.gravity.setZero();
      const Vec3 centre(far, -far, 0);
      BodyDef plate = body(box(1, thick, 0.1), centre, 0, e);
      plate.type = BodyType::kinematic;
      plate.angular_velocity = {0, 0, turn};
      w.add(plate);
      const Vec3 arm(s0, thick + r + 1e-4, 0);
      BodyDef d = body(sphere(r), centre + arm, 0, e);
      d.velocity = plate.angular_velocity.cross(arm) + Vec3(speed, -0.3, 0);
      w.add(d);
      w.run(time);
      const Vec3 along = w.bodies[0].pose.inverse_point(w.bodies[1].pose.x);
      const double s = s0 * std::cosh(turn * time) + speed / turn * std::sinh(turn * time);
      CHECK(along.x() == doctest::Approx(s).epsilon(2e-3));  // it had hopped a little
      CHECK(std::fabs(along.y() - thick - r) < 1e-8);
      CHECK(w.events < 40);
    }
}

TEST_CASE("event: a box that tumbles onto the floor loses energy only, and comes to rest") {
  EventWorld w;
  w.floor(0.4, 0.3);
  BodyDef d = body(box(0.3, 0.2, 0.4), {0, 1.5, 0}, 0.4, 0.3);
  d.angular_velocity = {2, 3, 1};
  d.velocity = {1, 0, 0.5};
  w.add(d);
  double energy = w.energy();
  for (int i = 0; i < 5 * 60; ++i) {
    w.step();
    CHECK(w.energy() <= energy + 1e-7 * std::fabs(energy));
    energy = w.energy();
  }
  CHECK(w.deepest < 1e-5);
  CHECK(w.bodies[1].v.norm() < 1e-6);
  MESSAGE("speed ", w.bodies[1].v.norm(), " height ", w.bodies[1].pose.x.y(), " deepest ",
          w.deepest);
}

TEST_CASE("event: a light ball that a heavy one shoots across the room meets what is there") {
  // Nothing foresees at the start of the tick that the light ball will be anywhere near the wall:
  // it is at rest. The heavy one comes at 20 m/s, so it leaves at nearly 40 m/s.
  EventWorld w(10);
  w.gravity.setZero();
  w.fixed(box(0.1, 5, 5), {3.1, 0, 0}, 0);
  BodyDef light = body(sphere(0.1), {0, 0, 0}, 0, 1), heavy = body(sphere(0.1), {-0.3, 0, 0}, 0, 1);
  light.mass = 1, heavy.mass = 1000;
  heavy.velocity = {20, 0, 0};
  w.add(light);
  w.add(heavy);
  w.step();
  // They touch at t = 0.1 / 20; then v' = 20 (1000 - 1) / 1001 and v' + 20; the wall is 2.9 m away.
  const double v_heavy = 20 * 999.0 / 1001, v_light = v_heavy + 20;
  const double back = 2.9 / v_light, t = 0.1 - 0.005;
  REQUIRE(back < t);
  // Of the two, coming towards each other from the wall, the second impact is not in this tick.
  const double x_light = 2.9 - v_light * (t - back), x_heavy = -0.2 + v_heavy * t;
  REQUIRE(x_light - x_heavy > 0.2);
  CHECK(w.bodies[1].pose.x.x() == doctest::Approx(x_light).epsilon(1e-9));
  CHECK(w.bodies[1].v.x() == doctest::Approx(-v_light).epsilon(1e-9));
  CHECK(w.bodies[2].pose.x.x() == doctest::Approx(x_heavy).epsilon(1e-9));
}

TEST_CASE("event: what whirls alone keeps its energy, however many turns it makes in a tick") {
  EventWorld w;
  w.gravity.setZero();
  BodyDef d = body(box(0.1, 0.02, 0.05), {0, 0, 0});
  d.angular_velocity = {900, 400, -700};
  w.add(d);
  const double start = w.energy();
  double worst = 0;
  for (int i = 0; i < 60; ++i) {
    w.step();
    worst = std::max(worst, std::fabs(w.energy() / start - 1));
  }
  MESSAGE("energy ", worst);
  CHECK(worst < 0.005);
}

TEST_CASE("event: a needle that turns alone keeps its energy, however thin") {
  for (const double half : {3e-3, 1e-3, 5e-4, 1.5e-4}) {
    CAPTURE(half);
    EventWorld w;
    w.gravity.setZero();
    BodyDef d = body(box(0.5, half, half), {0, 0, 0});
    d.angular_velocity = {100, 5, 1.5};
    w.add(d);
    const double start = w.energy();
    w.run(0.5);
    CHECK(std::fabs(w.energy() / start - 1) < 0.005);
  }
}

TEST_CASE("event: overlap from before never grows, and is worked off at the speed of recovery") {
  EventWorld w;
  w.floor();
  w.add(body(box(0.5, 0.5, 0.5), {0, 0.49, 0}));
  w.add(body(box(0.3, 0.3, 0.3), {0.1, 1.287, 0.05}));
  double lower = 0.01, upper = 0.003;
  for (int i = 1; i <= 40; ++i) {
    w.step();
    const double now = 0.5 - w.bodies[1].pose.x.y();
    const double above = w.bodies[1].pose.x.y() + 0.8 - w.bodies[2].pose.x.y();
    CHECK(now <= lower + 1e-8);
    CHECK(above <= upper + 1e-8);
    CHECK(now == doctest::Approx(std::max(0.0, 0.01 - i * 0.05 / 60)).scale(1).epsilon(1e-7));
    lower = now, upper = above;
    for (size_t k = 1; k <= 2; ++k) CHECK(w.bodies[k].v.norm() < 1e-7);
  }
  CHECK(std::fabs(lower) < 1e-7);
  CHECK(std::fabs(upper) < 1e-7);
}

TEST_CASE("event: the contacts saved and loaded go on with the same bits" *
          doctest::test_suite("long")) {
  EventWorld w;
  w.floor(0.4, 0.2);
  w.add(body(box(0.3, 0.2, 0.4), {0, 0.3, 0}, 0.4, 0.2));
  w.add(body(box(0.3, 0.2, 0.4), {0.1, 0.69, 0.03}, 0.4, 0.2));
  for (int i = 0; i < 40; ++i) {
    ByteWriter out;
    out.begin_section("event", 1);
    w.stepper.save(out);
    out.end_section();
    EventWorld copy;
    copy.bodies = w.bodies;
    ByteReader in(out.bytes());
    in.begin_section("event");
    REQUIRE(copy.stepper.load(in, 3));
    w.step();
    copy.step();
    for (size_t k = 0; k < w.bodies.size(); ++k) {
      CHECK(copy.bodies[k].pose.x == w.bodies[k].pose.x);
      CHECK(copy.bodies[k].pose.q.coeffs() == w.bodies[k].pose.q.coeffs());
      CHECK(copy.bodies[k].v == w.bodies[k].v);
    }
  }
  ByteWriter out;
  out.begin_section("event", 1);
  w.stepper.save(out);
  out.end_section();
  ByteReader in(out.bytes());
  in.begin_section("event");
  CHECK_FALSE(w.stepper.load(in, 2));
}

TEST_CASE(
    "event: every integrator runs through bounces, and those of higher order keep the height") {
  for (const ode::IntegratorEntry& e : ode::all_integrators()) {
    CAPTURE(e.name);
    EventWorld w;
    w.settings.integrator = e.name;
    w.floor(0, 1);
    w.add(body(sphere(0.1), {0, 1.1, 0}, 0, 1));
    const double e0 = w.energy();
    w.run(2);
    CHECK(w.deepest < 1e-5);
    CHECK(w.bodies[1].pose.x.y() > 0.1 - 1e-5);
    CHECK(std::fabs(w.energy() / e0 - 1) < (e.order >= 2 ? 1e-9 : 0.5));
  }
}
