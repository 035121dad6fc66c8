// Gravity that follows a course over time, under both steppers. References: its double integral for
// whatever is free (bodies, particles, grains, a drop of a fluid), with the error of second order
// in the tick that `realtime` has; a pendulum in a field that turns at a constant rate, which
// swings in the axes of the field as in one at rest, with the period of the elliptic integral; the
// energy itself for the books; the same run from a snapshot and from the replay log.
#include "engine/dynamics/particles/fluid_def.hpp"
#include "engine/world/replay.hpp"
#include "tests/support/test_world.hpp"

#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include <fmt/format.h>

using namespace tumble;
using namespace tumble::test;

namespace {

TimeCourse over_time(const std::string& text) {
  auto made = TimeCourse::expression(text);
  REQUIRE_MESSAGE(made.ok(), why_not(made));
  return *std::move(made);
}

WorldSettings settings_of(const char* stepper, int hz, VaryingVec3 gravity) {
  WorldSettings s;
  s.stepper = stepper;
  s.tick = {hz, 1};
  s.event.integrator = "rk4";
  s.gravity = std::move(gravity);
  return s;
}

double unexplained(const TestWorld& w) {
  return std::fabs(w.world->frame()->ledger->line(LedgerLine::integrator).total().balance);
}

VaryingVec3 swinging() {
  return {0, over_time("-9.81*cos(5*t)"), 0};
}
/// How far that moves at t what was at rest.
double fallen(double t) {
  return 9.81 / 25 * (std::cos(5 * t) - 1);
}

ParticleSystemDef cube_of_particles(double spacing, double mass) {
  ParticleSystemDef def;
  for (int i = 0; i < 27; ++i) {
    ParticleDef p;
    p.x = spacing * Vec3(i % 3, i / 3 % 3, i / 9);
    p.radius = 0.5 * spacing;
    p.mass = mass;
    def.particles.push_back(p);
  }
  return def;
}

ParticleSystemId add(TestWorld& w, ParticleSystemDef def) {
  const auto id = w->create_particles(std::move(def));
  REQUIRE_MESSAGE(id.ok(), why_not(id));
  w.apply();
  return *id;
}

/// Height of the centre of particles of equal mass.
double centre(const TestWorld& w, ParticleSystemId id) {
  double sum = 0;
  const ParticleSystem& p = *w.world->particles(id);
  for (const Vec3& x : p.x) sum += x.y();
  return sum / double(p.size());
}

}  // namespace

TEST_CASE("what is free moves by the double integral of gravity that swings") {
  const auto error = [](const char* stepper, int hz) {
    CAPTURE(stepper);
    CAPTURE(hz);
    TestWorld w(settings_of(stepper, hz, swinging()));
    BodyDef ball = TestWorld::sphere_def({0, 0, 0}, 0.1);
    const BodyId one = w.add(ball);
    ball.pose.x = {3, 0, 0};
    ball.gravity_scale = -0.5;
    const BodyId other = w.add(ball);
    w.run(1.5);
    CHECK(w.body(other).pose.x.y() == doctest::Approx(-0.5 * w.body(one).pose.x.y()));
    return std::fabs(w.body(one).pose.x.y() - fallen(1.5));
  };
  CHECK(error("event", 60) < 1e-6);
  CHECK(error("event", 30) < 1e-5);
  const double fine = error("realtime", 120);
  CHECK(fine < 1e-3);
  CHECK(fine == doctest::Approx(error("realtime", 60) / 4).epsilon(0.1));
}

TEST_CASE("particles, grains and fluids fall by gravity that swings as bodies do") {
  for (const char* stepper : {"realtime", "event"})
    for (const char* kind : {"dust", "fast", "grains", "fluid"}) {
      CAPTURE(stepper);
      CAPTURE(kind);
      TestWorld w(settings_of(stepper, 120, swinging()));
      ParticleSystemDef def = cube_of_particles(0.1, 1);
      def.collide = false;
      if (kind == std::string("fast")) def.fast = true;
      if (kind == std::string("grains")) def.grains = GrainDef{0.1, 0.05}, def.collide = true;
      if (kind == std::string("fluid")) def.fluid = std::make_shared<const FluidDef>();
      const ParticleSystemId id = add(w, std::move(def));
      const double before = centre(w, id);
      w.run(0.6);
      // Of 0.78 m.
      CHECK(std::fabs(centre(w, id) - before - fallen(0.6)) < 2e-3);
      CHECK(unexplained(w) < 1e-3 * 27 * 9.81);
    }
}

TEST_CASE("a pendulum turns along with a field that turns, and swings about it") {
  // Relative to the field the equation is that of a pendulum in a field at rest, since the field
  // turns at a constant rate.
  const double k = 4, from = 1, rate = 1.5;  // own frequency squared, amplitude
  const double period = 4 / std::sqrt(k) * std::comp_ellint_1(std::sin(from / 2));
  constexpr double radius = 0.2, arm = 1;
  const double g = k * (arm * arm + 0.4 * radius * radius) / arm;
  const auto error = [&](const char* stepper, int hz) {
    const VaryingVec3 field{over_time(fmt::format("{}*sin({}*t)", g, rate)),
                            over_time(fmt::format("-{}*cos({}*t)", g, rate)), 0};
    TestWorld w(settings_of(stepper, hz, field));
    BodyDef bob = TestWorld::sphere_def({std::sin(from) * arm, -std::cos(from) * arm, 0}, radius);
    bob.angular_velocity = {0, 0, rate};
    bob.velocity = Vec3(0, 0, rate).cross(bob.pose.x);
    const BodyId id = w.add(bob);
    JointDef hinge;
    hinge.kind = JointKind::revolute;
    hinge.b = id;
    hinge.frame_b.x = -bob.pose.x;
    const auto joint = w->create_joint(hinge);
    REQUIRE_MESSAGE(joint.ok(), why_not(joint));
    w.run(period);
    const double t = w->time();
    // Within half a tick of the end of the swing.
    const double expected =
        from + rate * t - 0.5 * k * std::sin(from) * (t - period) * (t - period);
    const Vec3& x = w.body(id).pose.x;
    CHECK(unexplained(w) < 0.02);
    return std::fabs(std::remainder(std::atan2(x.x(), -x.y()) - expected, 2 * std::numbers::pi));
  };
  CHECK(error("event", 120) < 1e-5);
  const double fine = error("realtime", 240);
  CHECK(fine < 1e-3);
  CHECK(fine < 0.5 * error("realtime", 60));
}

TEST_CASE("the work of gravity that changes is on its line, and the books close") {
  for (const char* stepper : {"realtime", "event"}) {
    CAPTURE(stepper);
    TestWorld w(settings_of(stepper, 120, swinging()));
    const BodyId ball = w.sphere({0, 2, 0}, 0.1);
    const double g0 = 9.81, mass = w.body(ball).mass, start = mass * g0 * 2;
    w.run(0.6);
    const double g1 = 9.81 * std::cos(5 * 0.6);
    const RigidBody& b = w.body(ball);
    const double energy = b.kinetic_energy() + b.mass * g1 * b.pose.x.y();
    const auto& gravity = w->frame()->ledger->line(LedgerLine::gravity).total();
    CHECK(gravity.work == doctest::Approx(b.kinetic_energy()).epsilon(1e-4));
    CHECK(std::fabs(gravity.balance - (energy - start)) < 1e-3 * start);
    CHECK(unexplained(w) < 1e-3 * start);
  }
}

TEST_CASE("gravity wakes what rests when it begins to change, a table included") {
  for (const bool grains : {false, true}) {
    CAPTURE(grains);
    WorldSettings s =
        settings_of("realtime", 60, {*TimeCourse::table({{0, 0}, {3, 0}, {3.01, 6}}), -9.81, 0});
    TestWorld w(s);
    w.ground();
    BodyId box;
    ParticleSystemId sand;
    if (grains) {
      ParticleSystemDef def;
      def.grains = GrainDef{0.1, 0.05};
      ParticleDef p;
      p.radius = 0.01;
      p.mass = 0.01;
      p.x = {0, 0.01, 0};
      def.particles.push_back(p);
      sand = add(w, std::move(def));
    } else {
      box = w.box({0, 0.1, 0}, {0.1, 0.1, 0.1});
    }
    w.run(2.8);
    CHECK((grains ? w->particles(sand)->rest[0].asleep() : w.body(box).asleep));
    w.run(1);
    CHECK((grains ? w->particles(sand)->x[0].x() : w.body(box).pose.x.x()) > 0.1);
  }
}

TEST_CASE("gravity on a course goes on from a snapshot and from the replay log, bit by bit") {
  for (const char* stepper : {"realtime", "event"}) {
    CAPTURE(stepper);
    TestWorld w(settings_of(stepper, 60, swinging()));
    const BodyId ball = w.sphere({0, 5, 0}, 0.1);
    w.run(0.7);
    CHECK(w->settings().gravity.now().y() ==
          doctest::Approx(-9.81 * std::cos(5 * w->time())).epsilon(1e-12));
    const Bytes saved = w->save();
    w.run(0.5);
    auto other = World::create();
    REQUIRE(other.ok());
    REQUIRE((*other)->load(saved).ok());
    for (int i = 0; i < 30; ++i) REQUIRE((*other)->step().ok());
    CHECK((*other)->state_hash() == w->state_hash());
    WorldSettings s = w->settings();
    s.gravity = {over_time("t"), -1, 0};
    REQUIRE(w->set_settings(s).ok());
    const double before = w.body(ball).v.x(), t = w->time();
    w.run(0.2);
    CHECK(w.body(ball).v.x() - before ==
          doctest::Approx(0.5 * (w->time() * w->time() - t * t)).epsilon(1e-9));
    const auto replayed = run_replay(save_replay(*w.world));
    REQUIRE(replayed.ok());
    CHECK(replayed->same);
  }
}

TEST_CASE("gravity without a finite value stops the tick and says so") {
  TestWorld w(settings_of("realtime", 60, {0, over_time("-1/(t < 0.5)"), 0}));
  w.sphere({0, 5, 0}, 0.1);
  for (int i = 0; i < 29; ++i) w.step();
  Result<StepReport> failed = w->step();
  if (failed.ok()) failed = w->step();
  REQUIRE_FALSE(failed.ok());
  CHECK(failed.error().text().find("settings.gravity") != std::string::npos);
  CHECK(failed.error().text().find("no finite value") != std::string::npos);
  CHECK(w->settings().gravity.now().y() == -1);
}
