// Nets of springs that fall on the ground, on a ball and on each other. References: the energy that
// there was, to which contacts and springs only can take away; the weight of what lies still; the
// momentum of what meets in free space; Coulomb's friction of a net on a slope; a world that was
// saved and loaded.
#include "engine/core/random.hpp"
#include "engine/dynamics/forces/weave.hpp"
#include "tests/support/test_world.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;
using test::TestWorld;

namespace {

struct Lattice {
  int side = 4;
  double spacing = 0.1, stiffness = 200, damping = 1, noise = 0.1;
  Vec3 corner = Vec3(0, 0.3, 0), velocity = Vec3::Zero(), spin = Vec3::Zero();
  uint64_t seed = 1;
};

/// Particles on a lattice that is somewhat out of order, on springs to all that are near.
ParticleSystemId add_lattice(TestWorld& w, const Lattice& l) {
  ParticleSystemDef def;
  Random random(l.seed);
  for (int i = 0; i < l.side * l.side * l.side; ++i) {
    ParticleDef p;
    p.x = l.corner + l.spacing * Vec3(i % l.side, i / l.side % l.side, i / l.side / l.side);
    p.x += l.noise * l.spacing *
           Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    p.v = l.velocity + l.spin.cross(p.x - l.corner - Vec3::Constant(1.5 * l.spacing));
    p.mass = 0.001;
    p.radius = 0.35 * l.spacing;
    def.particles.push_back(p);
  }
  const auto id = w->create_particles(def);
  REQUIRE(id.ok());
  w.apply();
  const auto particle = [&](size_t i) {
    return Anchor{Anchor::Kind::particle, {}, *id, i + 1, Vec3::Zero()};
  };
  for (size_t i = 0; i < def.particles.size(); ++i)
    for (size_t k = i + 1; k < def.particles.size(); ++k) {
      const double apart = (def.particles[i].x - def.particles[k].x).norm();
      if (apart > 2 * l.spacing) continue;
      SpringDef spring;
      spring.a = particle(i), spring.b = particle(k);
      spring.stiffness = l.stiffness;
      spring.damping = l.damping;
      spring.rest_length = apart;
      REQUIRE(w->create_force(spring).ok());
    }
  w.apply();
  return *id;
}

/// 15 by 15 nodes, on edge and leaning or flat, on its way down.
void add_cloth(TestWorld& w, double stretch, bool on_edge) {
  ClothDef def;
  def.sheet.corner = on_edge ? Vec3(-0.4, 0.1, 0) : Vec3(-0.4, 0.8, -0.4);
  def.sheet.across = Vec3(0.8, 0, 0);
  def.sheet.down = on_edge ? Vec3(0, 0.8, 0.08) : Vec3(0, 0, 0.8);
  def.sheet.columns = def.sheet.rows = 15;
  def.density = 0.25;
  def.stretch = stretch;
  def.shear = 0.4 * stretch;
  def.bend = 4e-4;
  Result<Weave> weave = weave_cloth(def);
  REQUIRE(weave.ok());
  ParticleSystemDef particles;
  particles.particles = weave->particles;
  for (ParticleDef& p : particles.particles) p.v = Vec3(0.5, -4, 0);
  const auto id = w->create_particles(particles);
  REQUIRE(id.ok());
  w.apply();
  w.force(tie(std::move(*weave), *id, 1));
}

WorldSettings settings(int hz) {
  WorldSettings s;
  s.tick.num = hz;
  return s;
}

/// Ticks per second at which nets are dropped: the long ticks, and with all counts short ones too.
std::vector<int> rates() {
  if (test::all_counts()) return {60, 240};
  return {60};
}

/// From soft nets to those that no contact bends [N/m]; in the gate one of each.
std::vector<double> stiffnesses() {
  if (test::only_to_run()) return {2e6};
  if (test::all_counts()) return {20, 200, 2e4, 2e6};
  return {200, 2e6};
}

/// Both of two kinds of cases; where the code is only to run, the second alone.
template <class T>
std::vector<T> both(T first, T second) {
  if (test::only_to_run()) return {second};
  return {first, second};
}

/// Most that the energy rises above what it has been since the start, in shares of what motion and
/// height there was to lose.
double worst_rise(TestWorld& w, double seconds) {
  double least = w->frame()->stats.energies.total(), worst = 0;
  const double all = std::fabs(least);
  for (int i = 0; i < int(seconds / w->settings().tick.tick()); ++i) {
    w.step();
    const double now = w->frame()->stats.energies.total();
    worst = std::max(worst, now - least);
    least = std::min(least, now);
  }
  return worst / all;
}

/// What contacts have given so far, across and along their normals [N s].
Vec3 given(TestWorld& w, LedgerLine line) {
  return w->frame()->ledger->line(line).total().momentum;
}

double fastest(TestWorld& w, ParticleSystemId id) {
  double most = 0;
  for (const Vec3& v : w->particles(id)->v) most = std::max(most, v.norm());
  return most;
}

}  // namespace

TEST_CASE("a net that falls on the ground or a ball gains no energy") {
  for (const double stiffness : stiffnesses())
    for (const int hz : rates())
      for (const bool ball : both(false, true)) {
        CAPTURE(stiffness);
        CAPTURE(hz);
        CAPTURE(ball);
        TestWorld w(settings(hz));
        w.ground();
        if (ball) {
          BodyDef def = TestWorld::sphere_def({0.13, 0.2, 0.13}, 0.2);
          def.type = BodyType::fixed;
          w.add(def);
        }
        Lattice l;
        l.stiffness = stiffness;
        l.corner.y() = ball ? 0.6 : 0.3;
        l.velocity = Vec3(0.5, -5, 0);
        l.seed = uint64_t(stiffness) + uint64_t(hz);
        add_lattice(w, l);
        // Where sweeps end before springs are solved it is bounded; it was 1e6 times as much.
        CHECK(worst_rise(w, 0.5) < (stiffness > 1e5 ? 20 : 0.01));
      }
}

TEST_CASE("event: a net that is time-stepped gains no energy where it meets something") {
  for (const double stiffness : both(200.0, 2e4)) {
    CAPTURE(stiffness);
    WorldSettings s = settings(60);
    s.stepper = "event";
    TestWorld w(s, 1, "time-stepping moved them");
    w.ground();
    Lattice l;
    l.stiffness = stiffness;
    l.damping = 0;
    l.velocity = Vec3(0.5, -5, 0);
    add_lattice(w, l);
    CHECK(worst_rise(w, 0.3) < 0.01);
    CHECK(w->frame()->stats.time_stepped > 0);
  }
}

TEST_CASE("event: a rope on which a heavy ball hangs gains no energy when it is time-stepped") {
  WorldSettings s = settings(60);
  s.stepper = "event";
  TestWorld w(s, 1, "time-stepping moved them");
  BodyDef def = TestWorld::sphere_def({2, 3.5, 0}, 0.2);
  def.mass = 100;
  const BodyId ball = w.add(def);
  RopeDef rope;
  rope.places.resize(2);
  rope.places[0].anchor.point = rope.places[0].x = Vec3(0, 3.5, 0);
  rope.places[1].anchor = {Anchor::Kind::body, ball, {}, 0, Vec3::Zero()};
  rope.places[1].x = def.pose.x;
  rope.segments = 20;
  rope.density = 0.05;
  rope.stiffness = 1e5;
  Result<Weave> weave = weave_rope(rope);
  REQUIRE(weave.ok());
  ParticleSystemDef particles;
  particles.particles = weave->particles;
  const auto id = w->create_particles(particles);
  REQUIRE(id.ok());
  w.apply();
  w.force(tie(std::move(*weave), *id, 1));
  CHECK(worst_rise(w, 0.5) < 0.01);
}

TEST_CASE("a net at rest on the ground lies on it, and presses with its weight" *
          doctest::test_suite("long")) {
  for (const double stiffness : both(200.0, 2e4)) {
    CAPTURE(stiffness);
    TestWorld w(settings(60));
    w.ground();
    Lattice l;
    l.stiffness = stiffness;
    l.corner.y() = 0.05;
    const auto id = add_lattice(w, l);
    LinearDragDef air;
    air.rate = 2;
    w.force(air);
    w.run(6);
    const Vec3 before = given(w, LedgerLine::restitution);
    w.run(0.5);
    const double force = (given(w, LedgerLine::restitution) - before).y() / 0.5;
    CHECK(force == doctest::Approx(64 * 0.001 * 9.81).epsilon(1e-3));
    CHECK(fastest(w, id) < 0.01);
    double lowest = 1;
    for (const Vec3& x : w->particles(id)->x) lowest = std::min(lowest, x.y());
    CHECK(lowest == doctest::Approx(0.035).epsilon(0.01));
  }
}

TEST_CASE("a stiff net that turns in free flight gains no energy, and loses little spin") {
  WorldSettings free = settings(60);
  free.gravity = Vec3::Zero();
  TestWorld w(free);
  Lattice l;
  l.stiffness = 2e4;
  l.spin = Vec3(1, 2, -3);
  add_lattice(w, l);
  const Vec3 before = w->frame()->stats.angular_momentum;
  CHECK(worst_rise(w, 1) < 0.01);
  CHECK((w->frame()->stats.angular_momentum - before).norm() < 0.25 * before.norm());
}

TEST_CASE("a cloth that falls on its edge, flat or on a ball gains no energy") {
  for (const double stretch : both(200.0, 5000.0))
    for (const int hz : rates())
      for (const bool ball : both(false, true)) {
        CAPTURE(stretch);
        CAPTURE(hz);
        CAPTURE(ball);
        TestWorld w(settings(hz));
        w.ground();
        if (ball) {
          BodyDef def = TestWorld::sphere_def({0, 0.4, 0}, 0.3);
          def.type = BodyType::fixed;
          w.add(def);
        }
        add_cloth(w, stretch, !ball);
        CHECK(worst_rise(w, 0.4) < 0.01);
      }
}

TEST_CASE("a net that is pressed goes on the same after it was saved and loaded") {
  TestWorld w(settings(60));
  w.ground();
  Lattice l;
  l.corner.y() = 0.1;
  l.velocity = Vec3(0, -3, 0);
  add_lattice(w, l);
  for (int tick = 0; tick < 12; ++tick) {
    auto made = World::create({});
    REQUIRE(made.ok());
    World& copy = **made;
    REQUIRE(copy.load(w->save()).ok());
    w.step();
    REQUIRE(copy.step().ok());
    CHECK(copy.state_hash() == w->state_hash());
  }
}

TEST_CASE("two nets that meet in free space keep their momentum, and gain no energy") {
  for (const double stiffness : both(200.0, 2e4)) {
    CAPTURE(stiffness);
    WorldSettings free = settings(60);
    free.gravity = Vec3::Zero();
    TestWorld w(free);
    Lattice left, right;
    left.stiffness = right.stiffness = stiffness;
    left.velocity = Vec3(2, 0.1, 0);
    right.corner.x() = 0.5;
    right.seed = 2;
    add_lattice(w, left);
    add_lattice(w, right);
    const Vec3 momentum = w->frame()->stats.momentum;
    CHECK(worst_rise(w, 0.5) < 0.01);
    CHECK((w->frame()->stats.momentum - momentum).norm() < 1e-9 * momentum.norm());
    CHECK(given(w, LedgerLine::restitution).norm() < 1e-12);
  }
}

TEST_CASE("a net on a slope sticks or slides as a block does") {
  // tan 20 degrees is 0.364.
  const double angle = 20 * 3.141592653589793 / 180;
  for (const double friction : {0.5, 0.2}) {
    CAPTURE(friction);
    WorldSettings tilted = settings(60);
    tilted.gravity = 9.81 * Vec3(std::sin(angle), -std::cos(angle), 0);
    TestWorld w(tilted);
    ShapeDef plane;
    plane.type = ShapeType::half_space;
    BodyDef ground = TestWorld::shape_def(plane, Vec3::Zero(), BodyType::fixed);
    ground.shapes[0].material.friction = friction * friction / 0.5;  // a particle's is 0.5
    w.add(ground);
    Lattice l;
    l.stiffness = 2000;
    l.noise = 0;
    l.corner.y() = 0.036;
    const auto id = add_lattice(w, l);
    const auto speed = [&] {
      Vec3 sum = Vec3::Zero();
      for (const Vec3& v : w->particles(id)->v) sum += v / 64;
      return sum.x();
    };
    w.run(0.5);
    const double before = speed();
    w.run(0.5);
    const double slides = 9.81 * (std::sin(angle) - friction * std::cos(angle));
    CHECK((speed() - before) / 0.5 ==
          doctest::Approx(std::max(0.0, slides)).epsilon(0.02).scale(9.81));
  }
}
