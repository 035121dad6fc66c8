// Worlds under the event stepper. References: closed forms (oscillator, drag, bounces, Coulomb's
// law), conservation laws, overlap by separating axes and centres alone, the same world never
// saved.
#include "engine/core/random.hpp"
#include "engine/dynamics/event/impulses/impact_law.hpp"
#include "engine/math/ode/integrator.hpp"
#include "engine/world/replay.hpp"
#include "tests/support/test_world.hpp"
#include "tests/support/why_not.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;
using test::TestWorld;

namespace {

/// Some collisions have no simultaneous answer.
constexpr const char* fallback = "found no answer to a collision";

WorldSettings event_settings(int hz = 60, const Vec3& gravity = {0, -9.81, 0}) {
  WorldSettings s;
  s.stepper = "event";
  s.event.budget = 1000000;  // what is claimed of events is not left to time-stepping
  s.tick.num = hz;
  s.gravity = gravity;
  return s;
}

BodyDef with_material(BodyDef def, double friction, double restitution = 0) {
  for (BodyShapeDef& s : def.shapes) {
    s.material.friction = friction;
    s.material.restitution = restitution;
  }
  return def;
}

BodyId floor_of(TestWorld& w, double friction, double restitution = 0) {
  ShapeDef s;
  s.type = ShapeType::half_space;
  return w.add(
      with_material(TestWorld::shape_def(s, Vec3::Zero(), BodyType::fixed), friction, restitution));
}

/// Error of a damped oscillator in one line after 1 s.
double oscillator_error(std::string_view integrator, int hz) {
  WorldSettings s = event_settings(hz, Vec3::Zero());
  s.event.integrator = integrator;
  TestWorld w(s);
  const BodyId b = w.sphere({1.5, 0, 0}, 0.1);
  const double m = w.body(b).mass, omega = 2 * M_PI * 1.5, rate = 0.4;
  SpringDef spring;
  spring.b.kind = Anchor::Kind::body;
  spring.b.body = b;
  spring.rest_length = 1;
  spring.stiffness = m * omega * omega;
  spring.damping = 0.6 * m;
  w.force(spring);
  w.force(LinearDragDef{rate, rate});
  w.run(1);
  // x'' = -2 g x' - omega^2 x, x(0) = 0.5, x'(0) = 0
  const double g = 0.5 * (0.6 + rate), d = std::sqrt(omega * omega - g * g), e = std::exp(-g);
  const double x = 0.5 * e * (std::cos(d) + g / d * std::sin(d));
  const double v = -0.5 * e * omega * omega / d * std::sin(d);
  return std::hypot(w.body(b).pose.x.x() - 1 - x, (w.body(b).v.x() - v) / omega);
}

/// Everything that the stepper knows: a pile, a spring between bodies, a spring to a particle,
/// drag.
std::vector<BodyId> fill(TestWorld& w, int count = 8) {
  floor_of(w, 0.5, 0.2);
  Random random(11);
  std::vector<BodyId> out;
  for (int i = 0; i < count; ++i) {
    const Vec3 x(random.uniform(-0.4, 0.4), 0.6 + 0.7 * i, random.uniform(-0.4, 0.4));
    out.push_back(i % 2 ? w.box(x, {0.3, 0.2, 0.4}) : w.sphere(x, 0.3));
  }
  ParticleSystemDef particles;
  particles.particles.resize(3);
  particles.particles[0].x = {2, 2, 0};
  particles.particles[1].x = {-2, 1, 0};
  particles.particles[2].x = {-2, 2, 0};
  const auto system = w->create_particles(particles);
  REQUIRE(system.ok());
  SpringDef spring;
  spring.a.kind = spring.b.kind = Anchor::Kind::body;
  spring.a.body = out[0], spring.b.body = out[1];
  w.force(spring);
  spring.a.kind = Anchor::Kind::particle;
  spring.a.particles = *system;
  spring.a.particle = 1;
  w.force(spring);
  w.force(LinearDragDef{0.05, 0.05});
  w.apply();
  return out;
}

/// How far two boxes overlap: the least of the depths along the fifteen axes that can separate them
/// [m]; negative where they are apart.
double box_overlap(const RigidBody& a, const Vec3& ha, const RigidBody& b, const Vec3& hb) {
  const Mat3 A = a.pose.q.toRotationMatrix(), B = b.pose.q.toRotationMatrix();
  std::vector<Vec3> axes;
  for (int i = 0; i < 3; ++i) {
    axes.push_back(A.col(i));
    axes.push_back(B.col(i));
    for (int j = 0; j < 3; ++j) {
      const Vec3 n = A.col(i).cross(B.col(j));
      if (n.norm() > 1e-6) axes.push_back(n.normalized());
    }
  }
  double least = 1e300;
  for (const Vec3& n : axes) {
    const double reach =
        (A.transpose() * n).cwiseAbs().dot(ha) + (B.transpose() * n).cwiseAbs().dot(hb);
    least = std::min(least, reach - std::fabs(n.dot(b.pose.x - a.pose.x)));
  }
  return least;
}

}  // namespace

TEST_CASE("event world: a damped spring converges with the order of every integrator") {
  for (const ode::IntegratorEntry& e : ode::all_integrators()) {
    CAPTURE(e.name);
    if (e.name == "rk45") {
      CHECK(oscillator_error(e.name, 60) < 1e-6);
      continue;
    }
    const int hz = e.order == 1 ? 960 : 120;
    const double coarse = oscillator_error(e.name, hz), fine = oscillator_error(e.name, 2 * hz);
    CAPTURE(coarse);
    CAPTURE(fine);
    CHECK(std::log2(coarse / fine) > e.order - 0.2);
    CHECK(std::log2(coarse / fine) < e.order + 0.5);
  }
}

TEST_CASE("event world: free fall and linear drag follow their closed forms") {
  TestWorld w(event_settings());
  BodyDef def = TestWorld::sphere_def({0, 100, 0}, 0.1);
  def.velocity = {10, 15, 0};
  def.angular_velocity = {0, 0, 3};
  const BodyId b = w.add(def);
  w.force(LinearDragDef{0.8, 0.8});
  w.run(2);
  const double c = 0.8, t = 2, e = std::exp(-c * t);
  CHECK(w.body(b).pose.x.x() == doctest::Approx(10 / c * (1 - e)).epsilon(1e-9));
  CHECK(w.body(b).pose.x.y() ==
        doctest::Approx(100 + (15 + 9.81 / c) / c * (1 - e) - 9.81 / c * t).epsilon(1e-9));
  CHECK(w.body(b).omega.z() == doctest::Approx(3 * e).epsilon(1e-9));
}

TEST_CASE("event world: springs between bodies and particles change no momentum") {
  TestWorld w(event_settings(60, Vec3::Zero()));
  const BodyId a = w.box({0, 0, 0}), b = w.sphere({3, 0, 1});
  ParticleSystemDef particles;
  particles.particles.resize(1);
  particles.particles[0].x = {0, 4, 0};
  particles.particles[0].mass = 20;
  const auto system = w->create_particles(particles);
  REQUIRE(system.ok());
  SpringDef spring;
  spring.stiffness = 3000, spring.damping = 20;
  spring.a.kind = spring.b.kind = Anchor::Kind::body;
  spring.a.body = a, spring.b.body = b;
  spring.a.point = {0.5, 0.5, 0.5};
  w.force(spring);
  spring.b.kind = Anchor::Kind::particle;
  spring.b.particles = *system;
  spring.b.particle = 1;
  w.force(spring);
  for (int i = 0; i < 120; ++i) {
    const StepStats s = w.step().stats;
    CHECK(s.momentum.norm() < 1e-9);  // of hundreds of kg m/s that each of them has
  }
  CHECK(w.body(a).v.norm() > 0.01);
  CHECK(w.body(b).v.norm() > 0.01);
}

TEST_CASE("event world: the mouse brings a body to its target and holds it there") {
  TestWorld w(event_settings());
  const BodyId b = w.box({0, 3, 0});
  MouseSpringDef mouse;
  mouse.anchor.kind = Anchor::Kind::body;
  mouse.anchor.body = b;
  mouse.anchor.point = {0, 0.5, 0};
  mouse.target = {1, 4, 0};
  w.force(mouse);
  w.run(5);
  // Held against its weight by a spring of 4 Hz: lower by g / (2 pi 4)^2.
  const double sag = 9.81 / std::pow(2 * M_PI * 4, 2);
  const RigidBody& body = w.body(b);
  CHECK((body.pose.point({0, 0.5, 0}) - Vec3(1, 4 - sag, 0)).norm() < 1e-4);
  CHECK(body.v.norm() < 1e-3);
}

TEST_CASE("event world: the same bits for 1, 2 and 4 threads") {
  std::vector<uint64_t> hashes;
  for (const int threads : {1, 2, 4}) {
    TestWorld w(event_settings(), threads, fallback);
    fill(w);
    BodyDef away = TestWorld::sphere_def({20, 2, 0});
    w.add(away);
    w.run(test::scaled(20) * 0.1);
    hashes.push_back(w->state_hash());
  }
  CHECK(hashes[1] == hashes[0]);
  CHECK(hashes[2] == hashes[0]);
}

TEST_CASE("event world: a snapshot has the same future and saves the same bytes") {
  TestWorld w(event_settings(), 1, fallback);
  fill(w, 5);
  for (int i = 0; i < test::scaled(60); ++i) {
    TestWorld copy({}, 1, fallback);
    const Status loaded = copy->load(w->save());
    REQUIRE_MESSAGE(loaded.ok(), test::why_not(loaded));
    w.step();
    copy.step();
    CHECK(copy->state_hash() == w->state_hash());
    TestWorld a, b;
    REQUIRE(a->load(w->save()).ok());
    REQUIRE(b->load(copy->save()).ok());
    const std::string section = first_difference(a->save(), b->save());
    CHECK_MESSAGE(section.empty(), "tick ", i, ": section ", section);
  }
}

TEST_CASE("event world: switching steppers while running leaves what rests where it is") {
  WorldSettings s = event_settings();
  s.stepper = "realtime";
  TestWorld w(s, 1, fallback);
  floor_of(w, 0.5);
  std::vector<BodyId> resting;
  for (int i = 0; i < 3; ++i) resting.push_back(w.box({double(i), 0.25, 0}, {0.25, 0.25, 0.25}));
  resting.push_back(w.sphere({3, 0.3, 0}, 0.3));
  BodyDef halves = TestWorld::box_def({4, 0.25, 0}, {0.2, 0.25, 0.25});
  halves.shapes.push_back(halves.shapes[0]);
  halves.shapes[0].pose.x.x() = -0.2;
  halves.shapes[1].pose.x.x() = 0.2;
  resting.push_back(w.add(halves));
  for (int turn = 0; turn < 6; ++turn) {
    s.stepper = turn % 2 ? "event" : "realtime";
    REQUIRE(w->set_settings(s).ok());
    double deepest = 1;
    for (int i = 0; i < 30; ++i) {
      w.step();
      for (size_t k = 0; k < resting.size(); ++k) {
        const RigidBody& b = w.body(resting[k]);
        CHECK(b.v.norm() < 0.05);
        CHECK((b.pose.x - Vec3(double(k), k == 3 ? 0.3 : 0.25, 0)).norm() < 5e-3);
      }
      if (turn % 2 == 0) continue;
      // What overlap the realtime stepper left only shrinks.
      const double now = w->frame()->stats.max_penetration;
      CHECK(now <= deepest + 1e-7);
      deepest = now;
    }
    if (turn % 2) CHECK(deepest < 1e-6);
  }
}

TEST_CASE("event world: what rested on a body that is destroyed falls, what it pulled flies on") {
  TestWorld w(event_settings(), 1, fallback);
  floor_of(w, 0.5);
  const BodyId below = w.box({0, 0.5, 0}), above = w.box({0, 1.5, 0});
  w.run(0.5);
  REQUIRE(w.body(above).v.norm() < 1e-9);
  REQUIRE(w->destroy_body(below).ok());
  w.run(0.25);
  CHECK(w.body(above).v.y() == doctest::Approx(-9.81 * 0.25).epsilon(1e-9));
  const BodyId again = w.sphere({0, 5, 0});  // takes the slot of the one that is gone
  w.run(1);
  CHECK(w.body(above).pose.x.y() == doctest::Approx(0.5).epsilon(1e-7));
  CHECK(w.body(again).pose.x.y() > 1);
}

TEST_CASE("event world: every integrator and law of impulses can be chosen while it runs") {
  TestWorld w(event_settings(), 1, fallback);
  fill(w, 4);
  const auto& integrators = ode::all_integrators();
  const auto& laws = all_impact_laws();
  const size_t rounds = test::all_counts() ? 2 : 1;
  const size_t step = test::only_to_run() ? 5 : 1;  // of the pairs
  for (size_t i = 0; i < rounds * integrators.size() * laws.size(); i += step) {
    WorldSettings s = w->settings();
    s.event.integrator = integrators[i % integrators.size()].name;
    s.event.impulses = laws[i % laws.size()].name;
    REQUIRE(w->set_settings(s).ok());
    w.step();
  }
  WorldSettings wrong = w->settings();
  wrong.event.integrator = "rk5";
  REQUIRE(!w->set_settings(wrong).ok());
  CHECK(w->set_settings(wrong).error().text().find("rk4") != std::string::npos);
  wrong = w->settings();
  wrong.event.impulses = "reflection";
  REQUIRE(!w->set_settings(wrong).ok());
  CHECK(w->set_settings(wrong).error().text().find("reflections") != std::string::npos);
}

TEST_CASE(
    "event world: a tick that breaks down leaves the world at the last good one, and says why") {
  WorldSettings s = event_settings();
  s.event.integrator = "explicit_euler";
  TestWorld w(s);
  BodyDef def = TestWorld::sphere_def({3, 0, 0}, 0.1);
  def.name = "bead";
  const BodyId b = w.add(def);
  SpringDef spring;
  spring.b.kind = Anchor::Kind::body;
  spring.b.body = b;
  spring.stiffness = 1e308;
  w.force(spring);
  const uint64_t before = w->state_hash();
  const auto report = w->step();
  REQUIRE(!report.ok());
  CHECK(report.error().text().find("bead") != std::string::npos);
  CHECK(w->state_hash() == before);
  CHECK(w->tick() == 0);
}

TEST_CASE("event world: heaps of balls and boxes overlap by no more than 1e-5 m" *
          doctest::test_suite("long")) {
  for (const bool boxes : {false, true}) {
    TestWorld w(event_settings(), 1, fallback);
    floor_of(w, 0.4, 0.2);
    Random random(5);
    std::vector<BodyId> heap;
    const Vec3 half(0.2, 0.15, 0.25);
    const int count = test::all_counts() ? 12 : 6;  // the time grows with the square of a heap
    for (int i = 0; i < count; ++i) {
      const Vec3 x(random.uniform(-0.3, 0.3), 0.4 + 0.45 * i, random.uniform(-0.3, 0.3));
      BodyDef def = boxes ? TestWorld::box_def(x, half) : TestWorld::sphere_def(x, 0.2);
      def.angular_velocity = {random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)};
      heap.push_back(w.add(with_material(def, 0.4, 0.2)));
    }
    double deepest = 0;
    for (int i = 0; i < test::graded_count(180, 80, 30); ++i) {
      w.step();
      for (size_t j = 0; j < heap.size(); ++j) {
        const RigidBody& a = w.body(heap[j]);
        double low = a.pose.x.y() - 0.2;
        if (boxes) low = a.pose.x.y() - a.pose.q.toRotationMatrix().row(1).cwiseAbs().dot(half);
        deepest = std::max(deepest, -low);
        for (size_t k = 0; k < j; ++k) {
          const RigidBody& b = w.body(heap[k]);
          deepest = std::max(
              deepest, boxes ? box_overlap(a, half, b, half) : 0.4 - (a.pose.x - b.pose.x).norm());
        }
      }
    }
    CAPTURE(boxes);
    CHECK(deepest < 1e-5);
  }
}

TEST_CASE("event world: a kinematic pusher moves what it touches, at its own speed") {
  TestWorld w(event_settings(), 1, fallback);
  floor_of(w, 0.2);
  BodyDef pusher = with_material(TestWorld::box_def({-1, 0.6, 0}), 0.2);
  pusher.type = BodyType::kinematic;
  pusher.velocity = {0.5, 0, 0};
  w.add(pusher);
  const BodyId b = w.add(with_material(TestWorld::box_def({0.3, 0.5, 0}), 0.2));
  w.run(2);
  CHECK(w.body(b).pose.x.x() == doctest::Approx(1).epsilon(1e-6));
  CHECK(w.body(b).v.x() == doctest::Approx(0.5).epsilon(1e-6));
}
