// Numbers of forces that follow courses over time, under both steppers. References: closed forms of
// one degree of freedom (a free mass and an oscillator under F sin(w t), a thrust that turns with
// its body), with the error of second order in the tick that `realtime` has; the energy itself for
// the books; the same run from a snapshot and from the replay log.
#include "engine/world/replay.hpp"
#include "tests/support/test_world.hpp"

#include <cmath>
#include <string>

using namespace tumble;
using namespace tumble::test;

namespace {

TimeCourse over_time(const char* text) {
  auto made = TimeCourse::expression(text);
  REQUIRE_MESSAGE(made.ok(), why_not(made));
  return *std::move(made);
}

/// A ball of 2 kg at the origin that falls nowhere, and does not turn unless told to.
struct Lab : TestWorld {
  static constexpr double mass = 2;
  BodyId ball;

  explicit Lab(const char* stepper, int hz = 60, const Vec3& v = Vec3::Zero())
      : TestWorld(settings_of(stepper, hz)) {
    BodyDef d = sphere_def(Vec3::Zero(), 0.1);
    d.mass = mass;
    d.inertia = Vec3(0.5, 0.5, 0.5);
    d.velocity = v;
    ball = add(d);
  }
  static WorldSettings settings_of(const char* stepper, int hz) {
    WorldSettings s;
    s.stepper = stepper;
    s.gravity = Vec3::Zero();
    s.tick = {hz, 1};
    s.event.integrator = "rk4";
    return s;
  }
  Anchor on_ball() const { return {Anchor::Kind::body, ball, {}, 0, Vec3::Zero()}; }
  void push(VaryingVec3 force, VaryingVec3 torque = {}, bool body_axes = false) {
    LoadDef load;
    load.anchor = on_ball();
    load.force = std::move(force);
    load.torque = std::move(torque);
    load.body_axes = body_axes;
    this->force(load);
  }
  /// A spring from far away along x that is at rest with the ball at the origin.
  SpringDef spring(double stiffness) const {
    SpringDef out;
    out.a.point = {-10, 0, 0};
    out.b = on_ball();
    out.stiffness = stiffness;
    out.damping = 0;
    out.rest_length = 10;
    return out;
  }
  double x() const { return body(ball).pose.x.x(); }
  double unexplained() const {
    return std::fabs(world->frame()->ledger->line(LedgerLine::integrator).total().balance);
  }
};

/// x at 2 s of an oscillator from rest under A sin(w t) per mass.
double driven(double own, double w, double A) {
  return A / (own * own - w * w) * (std::sin(2 * w) - w / own * std::sin(2 * own));
}

}  // namespace

TEST_CASE("a free mass under a force that swings: x = F (w t - sin w t) / (m w^2)") {
  const double F = 3, w = 5;
  const double expected = F / (Lab::mass * w * w) * (2 * w - std::sin(2 * w));
  const auto error = [&](const char* stepper, int hz) {
    Lab lab(stepper, hz);
    lab.push({over_time("3*sin(5*t)"), 0, 0});
    lab.run(2);
    const double work = lab.body(lab.ball).kinetic_energy();
    CHECK(lab->frame()->ledger->forces()[0].account.total().balance ==
          doctest::Approx(work).epsilon(1e-6));
    return std::fabs(lab.x() - expected);
  };
  CHECK(error("event", 60) < 1e-7);
  const double fine = error("realtime", 60);
  CHECK(fine < 2e-3);
  CHECK(fine == doctest::Approx(error("realtime", 30) / 4).epsilon(0.1));
}

TEST_CASE("an oscillator that a force or its spring's rest length drives") {
  const double own = 4, w = 2.5, A = 0.8;
  const double stiffness = Lab::mass * own * own;
  for (const bool by_spring : {false, true}) {
    INFO(by_spring);
    const auto run = [&](const char* stepper, int hz) {
      Lab lab(stepper, hz);
      SpringDef spring = lab.spring(stiffness);
      if (by_spring) spring.rest_length = over_time("10 + 0.05*sin(2.5*t)");  // A / own^2
      lab.force(spring);
      if (!by_spring) lab.push({over_time("1.6*sin(2.5*t)"), 0, 0});
      lab.run(2);
      return std::pair(std::fabs(lab.x() - driven(own, w, A)), lab.unexplained());
    };
    CHECK(run("event", 60).first < 1e-7);
    const auto coarse = run("realtime", 30), fine = run("realtime", 60);
    CHECK(fine.first < 1e-3);
    CHECK(fine.first < 0.3 * coarse.first);
    // The books, where the energy is about 0.05 J.
    CHECK(run("event", 60).second < 2e-4);
    CHECK(run("event", 120).second < 5e-5);
    CHECK(fine.second < 1e-3);
  }
}

TEST_CASE("both steppers swing alike in a field whose strength changes") {
  const auto run = [](const char* stepper, int hz) {
    Lab lab(stepper, hz, {1, 0, 0});
    AttractorDef pull;
    pull.strength = over_time("9 + 4*sin(6*t)");
    lab.force(pull);
    lab.run(1.5);
    return lab.x();
  };
  const double exact = run("event", 240);
  CHECK(std::fabs(run("event", 60) - exact) < 1e-6);
  CHECK(std::fabs(run("realtime", 240) - exact) < 2e-4);
}

TEST_CASE("energy that a field has no more after it is switched off is on its line") {
  for (const char* stepper : {"realtime", "event"}) {
    INFO(stepper);
    Lab lab(stepper, 60, {1, 0, 0});
    AttractorDef pull;
    pull.strength = over_time("4*(t < 0.5)");
    lab.force(pull);
    lab.run(1);
    const double stored = 0.5 * 4 * Lab::mass * std::pow(std::sin(1.0) / 2, 2);
    CHECK(lab->frame()->ledger->forces()[0].account.total().balance ==
          doctest::Approx(-stored).epsilon(0.05));
    CHECK(lab.unexplained() < 0.05 * stored);
  }
}

TEST_CASE("a thrust turns with its body, and a torque spins it up") {
  for (const char* stepper : {"realtime", "event"}) {
    INFO(stepper);
    Lab lab(stepper, 120);
    lab.push({3, 0, 0}, {0, 0, over_time("0.5*t")}, true);
    lab.run(1);
    CHECK(lab.body(lab.ball).omega.z() == doctest::Approx(0.5).epsilon(1e-9));
    // angle = t^3 / 6: the integrals of cos and sin of it by Simpson's rule.
    double vx = 0, vy = 0;
    for (int i = 0; i <= 1000; ++i) {
      const double t = i / 1000.0, angle = t * t * t / 6;
      const double weight = i == 0 || i == 1000 ? 1 : i % 2 == 1 ? 4 : 2;
      vx += weight / 3000 * std::cos(angle), vy += weight / 3000 * std::sin(angle);
    }
    const Vec3& v = lab.body(lab.ball).v;
    CHECK(v.x() == doctest::Approx(3 / Lab::mass * vx).epsilon(2e-4));
    CHECK(v.y() == doctest::Approx(3 / Lab::mass * vy).epsilon(1e-3));
  }
}

TEST_CASE("loads that cannot act are refused") {
  Lab lab("realtime");
  LoadDef load;
  load.force = Vec3(1, 0, 0);
  const auto says = [&lab](const LoadDef& def, const char* part) {
    CHECK(def.fault().find(part) != std::string::npos);
    CHECK_FALSE(lab->create_force(def).ok());
  };
  says(load, "on a body or a particle");
  load.anchor = lab.on_ball();
  load.torque = Vec3(0, 1, 0);
  load.body_axes = true;
  CHECK(load.fault().empty());
  CHECK(lab->create_force(load).ok());
  load.anchor.kind = Anchor::Kind::particle;
  says(load, "torque");
  load.torque = {0, 0, over_time("t")};  // none yet
  says(load, "torque");
  load.torque = {};
  says(load, "axes");
  load.body_axes = false;
  CHECK(load.fault().empty());
}

TEST_CASE("a force wakes what rests when its course begins to change") {
  TestWorld w;
  w.ground();
  const BodyId box = w.box({0, 0.1, 0}, {0.1, 0.1, 0.1});
  LoadDef load;
  load.anchor = {Anchor::Kind::body, box, {}, 0, Vec3::Zero()};
  load.force = {*TimeCourse::table({{0, 0}, {3, 0}, {3.5, 100}}), 0, 0};
  w.force(load);
  w.run(2.8);
  CHECK(w.body(box).asleep);
  w.run(1);
  CHECK(w.body(box).pose.x.x() > 0.1);
}

TEST_CASE("a pair force and a load wake resting grains when their course begins to change") {
  for (const bool load : {false, true}) {
    CAPTURE(load);
    TestWorld w;
    w.ground();
    ParticleSystemDef def;
    def.name = "grains";
    def.grains = GrainDef{0.1, 0.05};
    def.charge = 1;
    for (const double x : {0.0, 0.1}) {
      ParticleDef p;
      p.radius = 0.01;
      p.mass = 0.01;
      p.x = {x, 0.01, 0};
      def.particles.push_back(p);
    }
    const auto id = w->create_particles(def);
    REQUIRE_MESSAGE(id.ok(), why_not(id));
    w.apply();
    const ParticleSystem& p = *w->particles(*id);
    if (load) {
      LoadDef pull;
      pull.anchor = {Anchor::Kind::particle, {}, *id, p.id[1], Vec3::Zero()};
      pull.force = {*TimeCourse::table({{0, 0}, {3, 0}, {3.5, 0.5}}), 0, 0};
      w.force(pull);
    } else {
      CoulombDef repulsion;
      repulsion.between = {*id};
      repulsion.strength = *TimeCourse::table({{0, 0}, {3, 0}, {3.5, 0.01}});
      w.force(repulsion);
    }
    w.run(2.8);
    CHECK(p.rest[1].asleep());
    w.run(1);
    CHECK(p.x[1].x() > 0.12);
  }
}

TEST_CASE("forces go on from a snapshot and from the replay log, bit by bit") {
  for (const char* stepper : {"realtime", "event"}) {
    Lab lab(stepper, 60, {0, 1, 0});
    SpringDef spring = lab.spring(50);
    spring.rest_length = over_time("10 + 0.1*sin(7*t)");
    spring.stiffness = *TimeCourse::table({{0, 50}, {1, 10}});
    const ForceId id = lab.force(spring);
    lab.push({0, over_time("cos(t)"), 1});
    lab.run(0.7);
    const Bytes saved = lab->save();
    lab.run(0.5);
    auto other = World::create();
    REQUIRE(other.ok());
    REQUIRE((*other)->load(saved).ok());
    for (int i = 0; i < 30; ++i) REQUIRE((*other)->step().ok());
    CHECK((*other)->state_hash() == lab->state_hash());
    spring.damping = over_time("1 + 0*t");
    REQUIRE(lab->set_force(id, spring).ok());
    lab.run(0.2);
    const auto replayed = run_replay(save_replay(*lab.world));
    REQUIRE(replayed.ok());
    CHECK(replayed->same);
  }
}

TEST_CASE("a course that leads a force out of its range stops the tick and says so") {
  Lab lab("realtime");
  SpringDef spring = lab.spring(50);
  spring.stiffness = over_time("1 - 2*t");
  lab.force(spring);
  for (int i = 0; i < 29; ++i) lab.step();
  Result<StepReport> failed = lab->step();
  if (failed.ok()) failed = lab->step();
  REQUIRE_FALSE(failed.ok());
  CHECK(failed.error().text().find("leads out of range: stiffness must be") != std::string::npos);
}

TEST_CASE("a uniform field for one body is gravity for it alone") {
  Lab lab("realtime");
  const BodyId other = lab.sphere({5, 0, 0}, 0.1);
  UniformFieldDef field;
  field.targets.bodies = {lab.ball};
  field.a = {0, -2, over_time("6*t")};
  lab.force(field);
  lab.run(1);
  CHECK(lab.body(lab.ball).pose.x.y() == doctest::Approx(-1).epsilon(1e-9));
  CHECK(lab.body(lab.ball).v.z() == doctest::Approx(3).epsilon(1e-9));
  CHECK(lab.body(other).v.norm() == 0);
  CHECK(lab.unexplained() < 1e-3);
}
