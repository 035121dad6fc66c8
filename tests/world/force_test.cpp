// Forces through the World. References: closed-form trajectories, within the error of a first-order
// step that is computed from the discrete recurrence or from halving the tick.
#include "tests/support/test_world.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;
using test::TestWorld;

namespace {

WorldSettings settings(int hz, const Vec3& gravity = {0, -9.81, 0}) {
  WorldSettings s;
  s.tick.num = hz;
  s.gravity = gravity;
  s.realtime.sleeping = false;
  return s;
}

}  // namespace

TEST_CASE("free fall: y = y0 - g t^2 / 2 exactly, whatever the tick") {
  for (const int hz : {30, 60, 240}) {
    TestWorld w(settings(hz));
    const BodyId b = w.sphere({0, 100, 0});
    w.run(2);
    CHECK(w.body(b).pose.x.y() == doctest::Approx(100 - 0.5 * 9.81 * 4).epsilon(1e-12));
    CHECK(w.body(b).v.y() == doctest::Approx(-9.81 * 2).epsilon(1e-12));
  }
}

TEST_CASE("projectile with linear drag: terminal velocity and range as in the closed form") {
  TestWorld w(settings(240));
  const BodyId b = w.sphere({0, 0, 0}, 0.1);
  w.force(LinearDragDef{0.8, 0.8});
  REQUIRE(w->set_velocity(b, {10, 15, 0}, {0, 0, 3}).ok());
  w.run(2);
  const double c = 0.8, t = 2, e = std::exp(-c * t);
  CHECK(w.body(b).pose.x.x() == doctest::Approx(10 / c * (1 - e)).epsilon(4e-3));
  CHECK(w.body(b).pose.x.y() ==
        doctest::Approx((15 + 9.81 / c) / c * (1 - e) - 9.81 / c * t).epsilon(2e-2));
  CHECK(w.body(b).v.x() == doctest::Approx(10 * e).epsilon(1e-10));
  CHECK(w.body(b).omega.z() == doctest::Approx(3 * e).epsilon(1e-6));
}

TEST_CASE("quadratic drag: v = v0 / (1 + k v0 t) without gravity, and never overshoots") {
  for (const int hz : {30, 240}) {
    TestWorld w(settings(hz, Vec3::Zero()));
    const double r = 0.2;
    const BodyId b = w.sphere(Vec3::Zero(), r);
    QuadraticDragDef drag;
    drag.fluid_density = 1000;
    w.force(drag);
    REQUIRE(w->set_velocity(b, {20, 0, 0}, Vec3::Zero()).ok());
    w.run(1);
    const double k = 0.5 * 1000 * 0.47 * M_PI * r * r / w.body(b).mass;
    CHECK(w.body(b).v.x() == doctest::Approx(20 / (1 + k * 20)).epsilon(1e-9));
  }
}

// Reference: energy only goes away, and about a principal axis omega = omega0 / (1 + k omega0 t /
// I).
TEST_CASE("quadratic drag brakes the turning of a body of very unlike moments about every axis") {
  TestWorld w(settings(60, Vec3::Zero()));
  const BodyId needle = w.box({0, 0, 0}, {20, 0.01, 0.01});
  QuadraticDragDef drag;
  drag.fluid_density = 1.2;
  w.force(drag);
  const auto energy = [&] {
    const RigidBody b = w.body(needle);
    return 0.5 * b.omega.dot(b.inertia_world() * b.omega);
  };
  for (const Vec3& omega : {Vec3(3, 1, -2), Vec3(40, 0.1, 0), Vec3(0, 5, 5)}) {
    CAPTURE(omega.transpose());
    REQUIRE(w->set_pose(needle, {}).ok());
    REQUIRE(w->set_velocity(needle, Vec3::Zero(), omega).ok());
    w.step();
    double before = energy();
    for (int k = 0; k < 60; ++k) {
      w.step();
      CHECK(energy() <= before * (1 + 1e-12));
      before = energy();
    }
  }
  REQUIRE(w->set_pose(needle, {}).ok());
  REQUIRE(w->set_velocity(needle, Vec3::Zero(), {0, 5, 0}).ok());
  const RigidBody b = w.body(needle);
  const double k = 0.5 * drag.fluid_density * drag.coefficient * std::pow(b.bounding_radius, 5);
  w.run(1);
  CHECK(w.body(needle).omega.y() ==
        doctest::Approx(5 / (1 + k * 5 / b.inertia_body(1, 1))).epsilon(1e-9));
}

TEST_CASE("a stiff drag stays stable: the velocity decays without changing sign") {
  TestWorld w(settings(30, Vec3::Zero()));
  const BodyId b = w.sphere(Vec3::Zero());
  w.force(LinearDragDef{1e4, 1e4});
  REQUIRE(w->set_velocity(b, {1, 0, 0}, Vec3::Zero()).ok());
  w.step();
  CHECK(w.body(b).v.x() >= 0);
  CHECK(w.body(b).v.x() < 1e-6);
}

TEST_CASE("undamped spring: period 2 pi sqrt(m/k) and no drift of energy over 200 periods") {
  TestWorld w(settings(240, Vec3::Zero()));
  const BodyId b = w.sphere({0, 0, 0}, 0.5);
  const double m = w.body(b).mass, k = m * std::pow(2 * M_PI, 2);  // 1 Hz
  SpringDef spring;
  spring.a.point = Vec3(0, 3, 0);
  spring.b.kind = Anchor::Kind::body;
  spring.b.body = b;
  spring.stiffness = k;
  spring.damping = 0;
  spring.rest_length = 2.5;  // stretched by 0.5 m
  w.force(spring);
  int crossings = 0;
  double last = -0.5, highest = 0;
  double first_time = 0, last_time = 0;
  for (int i = 0; i < 240 * 200; ++i) {
    w.step();
    const double y = w.body(b).pose.x.y() - 0.5;
    highest = std::max(highest, std::fabs(y));
    if (last < 0 && y >= 0) {
      ++crossings;
      last_time = w->time() - y / w.body(b).v.y();
      if (crossings == 1) first_time = last_time;
    }
    last = y;
  }
  const double period = (last_time - first_time) / (crossings - 1);
  CHECK(period == doctest::Approx(1.0).epsilon(1e-3));
  CHECK(highest < 0.5 * 1.01);
  const double energy = w->frame()->stats.energies.total();
  CHECK(energy == doctest::Approx(0.5 * k * 0.25).epsilon(0.03));
}

TEST_CASE("damped spring: amplitude decays by exp(-c t / 2m)") {
  TestWorld w(settings(480, Vec3::Zero()));
  const BodyId b = w.sphere({0, 0, 0}, 0.5);
  const double m = w.body(b).mass, k = m * std::pow(2 * M_PI, 2), c = 0.4 * m;
  SpringDef spring;
  spring.a.point = Vec3(0, 3, 0);
  spring.b.kind = Anchor::Kind::body;
  spring.b.body = b;
  spring.stiffness = k;
  spring.damping = c;
  spring.rest_length = 2.5;
  w.force(spring);
  w.run(5);
  const double wd = std::sqrt(k / m - std::pow(c / (2 * m), 2)), t = 5,
               decay = std::exp(-c / (2 * m) * t);
  const double x = -0.5 * decay * (std::cos(wd * t) + c / (2 * m) / wd * std::sin(wd * t));
  CHECK(w.body(b).pose.x.y() - 0.5 == doctest::Approx(x).epsilon(0.01));
}

TEST_CASE("a spring far beyond the explicit bound stays bounded") {
  TestWorld w(settings(30));
  const BodyId b = w.sphere({0, 0, 0}, 0.1);
  SpringDef spring;
  spring.a.point = Vec3(0, 1, 0);
  spring.b.kind = Anchor::Kind::body;
  spring.b.body = b;
  spring.stiffness = 1e12;
  spring.damping = 0;
  spring.rest_length = 0.5;
  w.force(spring);
  w.run(5);
  CHECK((w.body(b).pose.x - Vec3(0, 0.5, 0)).norm() < 0.05);
}

TEST_CASE("mouse spring: the same motion for 1 g and 10 t, critically damped, from any tick") {
  for (const int hz : {30, 60, 1000}) {
    std::vector<double> heights;
    for (const double mass : {0.001, 1.0, 10000.0}) {
      TestWorld w(settings(hz));
      BodyDef def = TestWorld::box_def({0, 0, 0});
      def.mass = mass;
      const BodyId b = w.add(def);
      MouseSpringDef spring;
      spring.anchor = {Anchor::Kind::body, b, {}, 0, Vec3(0.5, 0.5, 0.5)};
      spring.target = Vec3(0.5, 2.5, 0.5);
      w.force(spring);
      w.run(3);
      const Vec3 held = w.body(b).body_frame().point(Vec3(0.5, 0.5, 0.5));
      // It hangs below the target by g / w^2.
      CHECK((held - spring.target - Vec3(0, -9.81 / std::pow(2 * M_PI * 4, 2), 0)).norm() < 1e-3);
      CHECK(w.body(b).omega.norm() < 3);
      heights.push_back(w.body(b).pose.x.y());
    }
    CHECK(heights[1] == doctest::Approx(heights[0]).epsilon(1e-6));
    CHECK(heights[2] == doctest::Approx(heights[0]).epsilon(1e-6));
  }
}

TEST_CASE("mouse spring pulls a particle") {
  TestWorld w(settings(60));
  ParticleSystemDef def;
  def.particles.resize(3);
  def.particles[1].x = Vec3(1, 0, 0);
  def.particles[2].x = Vec3(-1, 0, 0);
  auto id = w->create_particles(def);
  REQUIRE(id.ok());
  w.apply();
  MouseSpringDef spring;
  spring.anchor = {Anchor::Kind::particle, {}, *id, w->particles(*id)->id[1], Vec3::Zero()};
  spring.target = Vec3(1, 2, 0);
  w.force(spring);
  w.run(3);
  CHECK((w->particles(*id)->x[1] - spring.target).norm() < 0.05);
  CHECK(w->particles(*id)->x[0].y() < -40);
}

TEST_CASE("particles: free fall with drag meets the closed form, momentum and ids stay in order") {
  TestWorld w(settings(480));
  ParticleSystemDef def;
  def.name = "rain";
  for (int i = 0; i < 100; ++i) {
    ParticleDef p;
    p.x = Vec3(0.1 * i, 10, 0);
    def.particles.push_back(p);
  }
  auto id = w->create_particles(def);
  REQUIRE(id.ok());
  w.force(LinearDragDef{2, 0});
  w.run(1);
  const ParticleSystem* p = w->particles(*id);
  REQUIRE(p);
  const double e = std::exp(-2.0);
  for (size_t i = 0; i < p->size(); ++i) {
    CHECK(p->id[i] == i + 1);
    CHECK(p->v[i].y() == doctest::Approx(-9.81 / 2 * (1 - e)).epsilon(5e-3));
    CHECK(p->age[i] == doctest::Approx(1));
  }
}
