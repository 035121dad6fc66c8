// The books of energy and momentum. References: closed forms of what each cause must have done
// (m g h, mu N s, (1 - e^2) of the energy of an impact, m v of a push), and that the lines add up.
#include "tests/support/test_world.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;
using test::TestWorld;

namespace {

WorldSettings ledger_settings(int hz, const Vec3& gravity = {0, -9.81, 0}) {
  WorldSettings s;
  s.tick.num = hz;
  s.gravity = gravity;
  s.realtime.sleeping = false;
  return s;
}

LedgerEntry total(TestWorld& w, LedgerLine line) {
  return w->frame()->ledger->line(line).total();
}

LedgerEntry force_total(TestWorld& w, size_t slot) {
  return w->frame()->ledger->forces()[slot].account.total();
}

/// Sum over all lines.
LedgerEntry everything(const Ledger& ledger) {
  LedgerEntry sum;
  for (size_t i = 0; i < ledger_lines; ++i) sum.add(ledger.line(LedgerLine(i)).total());
  for (const ForceAccount& f : ledger.forces()) sum.add(f.account.total());
  return sum;
}

void check_closed(TestWorld& w) {
  const auto frame = w->frame();
  const LedgerEntry sum = everything(*frame->ledger);
  const StepStats& now = frame->stats;
  const double scale = frame->ledger->throughput() + std::fabs(now.energies.total());
  CHECK(std::fabs(sum.balance - now.energies.total()) < 1e-13 * scale);
  CHECK(std::fabs(sum.work - now.energies.kinetic) < 1e-13 * scale);
  // What went through the lines, at least.
  double moved = now.momentum.norm(), turned = now.angular_momentum.norm();
  for (size_t i = 0; i < ledger_lines; ++i) {
    const LedgerEntry line = frame->ledger->line(LedgerLine(i)).total();
    moved += line.momentum.norm();
    turned += line.angular_momentum.norm();
  }
  CHECK((sum.momentum - now.momentum).norm() < 1e-12 + 1e-14 * moved);
  CHECK((sum.angular_momentum - now.angular_momentum).norm() < 1e-12 + 1e-14 * turned);
}

BodyDef with_material(BodyDef def, double friction, double restitution) {
  def.shapes[0].material.friction = friction;
  def.shapes[0].material.restitution = restitution;
  return def;
}

}  // namespace

TEST_CASE("free fall: gravity's line is m g h, and the integrator has no error") {
  TestWorld w(ledger_settings(60));
  const BodyId ball = w.sphere({0, 100, 0}, 0.3);
  w.run(2);
  const double m = w.body(ball).mass, h = 0.5 * 9.81 * 4;
  CHECK(total(w, LedgerLine::gravity).work == doctest::Approx(m * 9.81 * h).epsilon(1e-12));
  CHECK(total(w, LedgerLine::gravity).momentum.y() ==
        doctest::Approx(-m * 9.81 * 2).epsilon(1e-12));
  CHECK(total(w, LedgerLine::gravity).balance == 0);
  CHECK(w->frame()->ledger->drift() < 1e-13);
  check_closed(w);
}

TEST_CASE("what rests does not drift: the digits of its energy are no error") {
  for (const char* stepper : {"event", "realtime"}) {
    WorldSettings settings = ledger_settings(60);
    settings.stepper = stepper;
    TestWorld w(settings);
    w.ground();
    for (int i = 0; i < 5; ++i) w.box({0.3, 1000.3 + 0.6 * i - 1000, -0.7}, {0.3, 0.3, 0.3});
    w.run(2);
    CHECK_MESSAGE(w->frame()->ledger->drift() < 1e-6, stepper);
  }
}

TEST_CASE("a bounce: restitution takes 1 - e^2 of the energy of the impact") {
  TestWorld w(ledger_settings(240));
  BodyDef ground = TestWorld::box_def({0, -1, 0}, {5, 1, 5});
  ground.type = BodyType::fixed;
  w.add(with_material(ground, 0, 0));
  const BodyId ball = w.add(with_material(TestWorld::sphere_def({0, 5.3, 0}, 0.3), 0, 0.8));
  w.run(1.3);  // it lands after 1.01 s
  REQUIRE(w.body(ball).v.y() > 0);
  const double m = w.body(ball).mass;
  CHECK(total(w, LedgerLine::restitution).balance ==
        doctest::Approx(-(1 - 0.64) * m * 9.81 * 5).epsilon(0.02));
  CHECK(std::fabs(total(w, LedgerLine::friction).balance) < 1e-12);
  CHECK(w->frame()->ledger->drift() < 1e-3);
  check_closed(w);
}

TEST_CASE("sliding to rest: friction takes the energy of motion, and gives its impulse back") {
  TestWorld w(ledger_settings(240));
  BodyDef ground = TestWorld::box_def({0, -1, 0}, {50, 1, 5});
  ground.type = BodyType::fixed;
  w.add(with_material(ground, 0.4, 0));
  const BodyId box =
      w.add(with_material(TestWorld::box_def({0, 0.25, 0}, {0.5, 0.25, 0.5}), 0.4, 0));
  w.run(0.5);
  const LedgerEntry before = total(w, LedgerLine::friction);
  REQUIRE(w->set_velocity(box, {3, 0, 0}, Vec3::Zero()).ok());
  w.run(2);
  const double m = w.body(box).mass;
  CHECK(w.body(box).v.norm() < 1e-6);
  const LedgerEntry friction = total(w, LedgerLine::friction);
  CHECK(friction.balance - before.balance == doctest::Approx(-0.5 * m * 9).epsilon(0.01));
  CHECK(friction.momentum.x() - before.momentum.x() == doctest::Approx(-3 * m).epsilon(1e-3));
  CHECK(total(w, LedgerLine::edits).momentum.x() == doctest::Approx(3 * m).epsilon(1e-9));
  CHECK(std::fabs(w->frame()->ledger->line(LedgerLine::integrator).total().balance) <
        0.01 * 0.5 * m * 9);
  check_closed(w);
}

TEST_CASE("a belt does work on what it carries along, friction takes as much") {
  TestWorld w(ledger_settings(240));
  BodyDef belt = TestWorld::box_def({0, -1, 0}, {50, 1, 5});
  belt.type = BodyType::fixed;
  belt.shapes[0].material.surface_velocity = Vec3(1.5, 0, 0);
  w.add(with_material(belt, 0.5, 0));
  const BodyId box =
      w.add(with_material(TestWorld::box_def({0, 0.25, 0}, {0.5, 0.25, 0.5}), 0.5, 0));
  w.run(3);
  const double m = w.body(box).mass, v = w.body(box).v.x();
  CHECK(v == doctest::Approx(1.5).epsilon(1e-3));
  CHECK(total(w, LedgerLine::kinematic).balance == doctest::Approx(m * v * v).epsilon(0.02));
  CHECK(total(w, LedgerLine::friction).balance == doctest::Approx(-0.5 * m * v * v).epsilon(0.02));
  check_closed(w);
}

TEST_CASE("what a ball loses to rolling and torsional friction is booked as friction") {
  for (const char* stepper : {"realtime", "event"}) {
    CAPTURE(stepper);
    WorldSettings settings = ledger_settings(240);
    settings.stepper = stepper;
    TestWorld w(settings);
    BodyDef floor = TestWorld::box_def({0, -1, 0}, {50, 1, 5});
    floor.type = BodyType::fixed;
    BodyDef ball = TestWorld::sphere_def({0, 0.25, 0}, 0.25);
    for (BodyDef* d : {&floor, &ball}) {
      d->shapes[0].material.friction = 0.8;
      d->shapes[0].material.rolling_friction = 0.02;
      d->shapes[0].material.torsional_friction = 0.01;
    }
    ball.velocity = {1.2, 0, 0};
    ball.angular_velocity = {0, 3, -1.2 / 0.25};
    w.add(floor);
    const BodyId id = w.add(ball);
    const double before = w.body(id).kinetic_energy();
    w.run(4);
    const bool exact = settings.stepper == "event";
    CHECK(w.body(id).kinetic_energy() < 1e-9 * before);
    CHECK(total(w, LedgerLine::friction).balance ==
          doctest::Approx(-before).epsilon(exact ? 1e-9 : 0.01));
    check_closed(w);
  }
}

TEST_CASE("a push is the user's, its energy and its momenta") {
  TestWorld w(ledger_settings(60, Vec3::Zero()));
  const BodyId box = w.box({1, 2, 3});
  REQUIRE(w->apply_impulse(box, {0, 0, 50}, {1.5, 2, 3}).ok());
  w.step();
  const RigidBody& b = w.body(box);
  CHECK(total(w, LedgerLine::user).balance == doctest::Approx(b.kinetic_energy()).epsilon(1e-9));
  CHECK(total(w, LedgerLine::user).momentum.z() == doctest::Approx(50));
  CHECK(
      (total(w, LedgerLine::user).angular_momentum - Vec3(1.5, 2, 3).cross(Vec3(0, 0, 50))).norm() <
      1e-9);
  CHECK(std::fabs(total(w, LedgerLine::edits).work) < 1e-12);
  check_closed(w);
}

TEST_CASE("every force has its line: a damped spring, drag, an attractor and a flow") {
  TestWorld w(ledger_settings(480));
  const BodyId ball = w.sphere({1, 0, 0}, 0.2);
  const double m = w.body(ball).mass;
  SpringDef spring;
  spring.a.point = Vec3(0, 1, 0);
  spring.b.kind = Anchor::Kind::body;
  spring.b.body = ball;
  spring.b.point = Vec3(0, 0.1, 0);
  spring.stiffness = 40 * m;
  spring.damping = 0.5 * m;
  w.force(spring);
  w.force(LinearDragDef{0.3, 0.3});
  AttractorDef attractor;
  attractor.strength = 3;
  w.force(attractor);
  WindDef wind;
  wind.grip.rate = 0.2;
  w.force(wind);
  w.run(4);
  CHECK(force_total(w, 0).balance < 0);  // damped
  CHECK(force_total(w, 1).balance == doctest::Approx(force_total(w, 1).work));
  CHECK(force_total(w, 1).balance < 0);
  CHECK(force_total(w, 2).balance == 0);
  CHECK(force_total(w, 3).momentum.x() > 0);
  CHECK(w->frame()->ledger->drift() < 2e-4);
  check_closed(w);
}

TEST_CASE("the integrator's error on an undamped spring falls with the square of the tick") {
  double drift[3];
  for (int i = 0; i < 3; ++i) {
    TestWorld w(ledger_settings(100 << i));
    const BodyId ball = w.sphere({0.4, -1, 0}, 0.2);
    SpringDef spring;
    spring.b.kind = Anchor::Kind::body;
    spring.b.body = ball;
    spring.stiffness = 30 * w.body(ball).mass;
    spring.damping = 0;
    w.force(spring);
    w.run(1.7);
    drift[i] = w->frame()->ledger->drift();
    check_closed(w);
  }
  CHECK(drift[2] < 1e-5);
  CHECK(std::log2(drift[0] / drift[1]) == doctest::Approx(2).epsilon(0.15));
  CHECK(std::log2(drift[1] / drift[2]) == doctest::Approx(2).epsilon(0.1));
}

TEST_CASE("particles are in the books: momentum by gravity and drag, to rounding") {
  TestWorld w(ledger_settings(60));
  ParticleSystemDef def;
  for (int i = 0; i < 50; ++i) {
    ParticleDef p;
    p.x = Vec3(0.1 * i, 1 + 0.3 * i, 0.05 * i * i);
    p.v = Vec3(0, 0, 0.1 * i);
    p.mass = 0.01 * (i + 1);
    def.particles.push_back(p);
  }
  REQUIRE(w->create_particles(def).ok());
  w.apply();
  w.force(LinearDragDef{1, 0});
  TurbulenceDef eddies;
  w.force(eddies);
  w.run(2);
  CHECK(w->frame()->ledger->drift() < 1e-12);  // gravity alone has a potential, and is exact
  CHECK(total(w, LedgerLine::integrator).momentum.norm() < 1e-12);
  CHECK(total(w, LedgerLine::integrator).angular_momentum.norm() < 1e-11);
  check_closed(w);
}

TEST_CASE("the line of a force that is destroyed goes on among past forces") {
  TestWorld w(ledger_settings(60));
  w.sphere({0, 5, 0});
  const ForceId drag = w.force(LinearDragDef{1, 1});
  w.run(0.5);
  const LedgerEntry done = force_total(w, 0);
  CHECK(done.work < 0);
  REQUIRE(w->destroy_force(drag).ok());
  AttractorDef attractor;
  w.force(attractor);  // in its slot
  w.step();
  CHECK(total(w, LedgerLine::past_forces).work == done.work);
  check_closed(w);
}

TEST_CASE("a heap that comes to rest: all of its energy is accounted for, and the books close") {
  WorldSettings s;
  s.tick.num = 60;
  TestWorld w(s);
  w.ground();
  for (int i = 0; i < 12; ++i) w.box({0.3 * (i % 3), 1 + 1.1 * i, 0.2 * (i % 2)});
  w.run(6);
  const auto frame = w->frame();
  CHECK(frame->ledger->drift() < 0.02);
  CHECK(total(w, LedgerLine::restitution).balance < 0);
  CHECK(total(w, LedgerLine::friction).balance < 0);
  check_closed(w);
}

TEST_CASE("books are in the snapshot and are replayed with the same bits") {
  TestWorld w(ledger_settings(60));
  w.ground();
  const BodyId box = w.box({0, 2, 0});
  w.force(LinearDragDef{0.1, 0.1});
  w.run(0.5);
  REQUIRE(w->apply_impulse(box, {1, 2, 3}, {0, 2, 0}).ok());
  w.apply();
  const Bytes saved = w->save();
  TestWorld other(ledger_settings(60));
  REQUIRE(other->load(saved).ok());
  w.run(1);
  other.run(1);
  const auto same = [](const LedgerEntry& a, const LedgerEntry& b) {
    return a.work == b.work && a.balance == b.balance && a.momentum == b.momentum &&
           a.angular_momentum == b.angular_momentum;
  };
  for (size_t i = 0; i < ledger_lines; ++i)
    CHECK(same(total(w, LedgerLine(i)), total(other, LedgerLine(i))));
  CHECK(same(force_total(w, 0), force_total(other, 0)));
  CHECK(w->frame()->ledger->throughput() == other->frame()->ledger->throughput());
}

TEST_CASE("event: overlap from before is worked off under its own line: what it lifts") {
  WorldSettings settings = ledger_settings(60);
  settings.stepper = "event";
  TestWorld w(settings);
  w.ground();
  const BodyId lower = w.box({0.1, 0.49, 0}, {0.5, 0.5, 0.5});    // 10 mm in the ground
  const BodyId upper = w.box({0, 1.287, 0.05}, {0.3, 0.3, 0.3});  // 3 mm in the lower one
  const auto heights = [&] {
    return w->body(lower)->mass * w->body(lower)->pose.x.y() +
           w->body(upper)->mass * w->body(upper)->pose.x.y();
  };
  const double start = heights();
  w.run(0.1);
  CHECK(total(w, LedgerLine::offset).balance ==
        doctest::Approx(9.81 * (heights() - start)).epsilon(1e-6));
  CHECK(heights() - start > 1);
  w.run(0.4);
  CHECK(w->body(lower)->pose.x.y() == doctest::Approx(0.5).epsilon(1e-9));
  const double lifted = 9.81 * (heights() - start);
  const LedgerEntry offset = total(w, LedgerLine::offset);
  CHECK(offset.balance == doctest::Approx(lifted).epsilon(1e-6));
  CHECK(offset.work == 0);  // nothing moves any faster for it
  CHECK(std::fabs(total(w, LedgerLine::projection).balance) < 1e-6 * lifted);
  CHECK(w->frame()->ledger->drift() < 1e-9);
  check_closed(w);
}

namespace {

/// A chain of balls that hangs horizontally on the world at first, joined between them.
std::vector<BodyId> add_chain(TestWorld& w, int balls, JointKind kind, const BodyDef& like) {
  std::vector<BodyId> out;
  for (int i = 0; i < balls; ++i) {
    BodyDef d = like;
    d.pose.x = {1.0 * i + 0.5, 0, 0};
    out.push_back(w.add(d));
    JointDef j;
    j.kind = kind;
    if (i > 0) j.a = out[size_t(i) - 1];
    j.b = out.back();
    j.frame_a.x = {i > 0 ? 0.5 : 0.0, 0, 0};
    j.frame_b.x = {-0.5, 0, 0};
    REQUIRE(w->create_joint(j).ok());
  }
  return out;
}

}  // namespace

TEST_CASE("joints: what they do is under their own line, and the books close") {
  // Balls: their inertia is the same however they turn, so nothing is left for the integrator.
  for (const int balls : {1, 4, 1500}) {  // the last in bundles of single precision
    TestWorld w(ledger_settings(60));
    BodyDef ball = TestWorld::sphere_def({}, 0.3);
    ball.group = 1;
    const std::vector<BodyId> chain = add_chain(w, balls, JointKind::spherical, ball);
    w.run(1);
    const Ledger& ledger = *w->frame()->ledger;
    const LedgerEntry joints = total(w, LedgerLine::joints);
    const LedgerEntry left = total(w, LedgerLine::integrator);
    CAPTURE(balls);
    MESSAGE("joints " << joints.work << " J of " << ledger.throughput() << " J, left "
                      << left.balance << " J");
    CHECK(std::fabs(left.balance) < (balls > 100 ? 1e-5 : 1e-11) * ledger.throughput());
    // Only gravity and what holds the chain changed its momentum.
    const Vec3 gained = total(w, LedgerLine::gravity).momentum + joints.momentum;
    CHECK((gained - w->frame()->stats.momentum).norm() <
          (balls > 100 ? 1e-5 : 1e-11) * total(w, LedgerLine::gravity).momentum.norm());
    CHECK(joints.balance < 1e-3 * ledger.throughput());  // they give no energy
    CHECK(total(w, LedgerLine::projection).work == 0);
    check_closed(w);
  }
}

TEST_CASE(
    "joints: a hinged rod swings without loss, and a motor that is a kinematic body drives it") {
  TestWorld w(ledger_settings(240, Vec3::Zero()));
  BodyDef wheel = TestWorld::box_def({0, 0, 0}, {0.5, 0.5, 0.1});
  wheel.type = BodyType::kinematic;
  wheel.angular_velocity = {0, 0, 2};
  wheel.group = 1;
  const BodyId driver = w.add(wheel);
  BodyDef rod = TestWorld::box_def({1.5, 0, 0}, {0.5, 0.05, 0.05});
  rod.group = 1;
  const BodyId driven = w.add(rod);
  JointDef weld;
  weld.kind = JointKind::rigid;
  weld.a = driver;
  weld.b = driven;
  weld.frame_a.x = {1, 0, 0};
  weld.frame_b.x = {-0.5, 0, 0};
  REQUIRE(w->create_joint(weld).ok());
  w.run(1);
  // It has been set in motion at one blow: the wheel does twice the work that the rod keeps.
  const double kept = w->frame()->stats.energies.kinetic;
  CHECK(w.body(driven).omega.z() == doctest::Approx(2).epsilon(1e-3));
  CHECK(total(w, LedgerLine::kinematic).work == doctest::Approx(2 * kept).epsilon(0.05));
  CHECK(total(w, LedgerLine::joints).balance == doctest::Approx(-kept).epsilon(0.1));
  check_closed(w);
}
