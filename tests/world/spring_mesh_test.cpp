// Cloths, ropes and nets in a world, under both steppers. References: closed forms (the catenary;
// the stretch rho g L^2 / 2E of a hanging sheet; the bending of a clamped strip, rho g L^4 / 8D;
// the period 4 pi/j0 sqrt(L/g) of a hanging chain, D. Bernoulli 1732; v - mu g t of what slides);
// momenta that nothing changes; a world that was saved and loaded; sums of the books.
#include "engine/dynamics/forces/weave.hpp"
#include "tests/support/test_world.hpp"
#include "tests/support/why_not.hpp"

#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

using namespace tumble;
using test::TestWorld;

namespace {

struct Woven {
  ParticleSystemId system;
  ForceId force;
};

Woven add_weave(TestWorld& w, Weave weave, bool collide = false, double break_strain = 0,
                double friction = ParticleSystemDef().friction) {
  ParticleSystemDef def;
  def.friction = friction;
  def.particles = weave.particles;
  def.collide = collide;
  const auto id = w->create_particles(def);
  REQUIRE_MESSAGE(id.ok(), test::why_not(id));
  w.apply();
  SpringMeshDef mesh = tie(std::move(weave), *id, 1);
  mesh.break_strain = break_strain;
  return {*id, w.force(mesh)};
}

Weave made(Result<Weave> weave) {
  REQUIRE_MESSAGE(weave.ok(), test::why_not(weave));
  return std::move(*weave);
}

WorldSettings settings(const char* stepper = "realtime", int hz = 60) {
  WorldSettings s;
  s.stepper = stepper;
  s.tick.num = hz;
  return s;
}

RopeDef rope_between(const Vec3& a, const Vec3& b, bool loose = false) {
  RopeDef d;
  d.places.resize(2);
  d.places[0].anchor.point = d.places[0].x = a;
  d.places[1].anchor.point = d.places[1].x = b;
  d.places[1].loose = loose;
  return d;
}

void add_air(TestWorld& w, double rate) {
  LinearDragDef drag;
  drag.rate = rate;
  w.force(drag);
}

/// A flat sheet that is crumpled and thrown.
ClothDef loose_cloth(int n) {
  ClothDef d;
  d.sheet.across = Vec3(0.5, 0, 0);
  d.sheet.down = Vec3(0, 0, 0.5);
  d.sheet.columns = d.sheet.rows = n;
  d.bend = 0.001;
  d.stretch = 100;
  d.shear = 20;
  return d;
}

Weave crumpled(const ClothDef& d, double size, double speed) {
  Weave weave = made(weave_cloth(d));
  for (size_t i = 0; i < weave.particles.size(); ++i) {
    ParticleDef& p = weave.particles[i];
    const double u = double(i);
    p.x += size * Vec3(std::sin(1.7 * u), std::sin(0.9 * u), std::cos(1.3 * u));
    p.v = speed * Vec3(std::sin(0.3 * u), 1 + std::cos(2.1 * u), std::sin(1.1 * u));
  }
  return weave;
}

}  // namespace

TEST_CASE("a rope comes to rest as a catenary within 1 % of its sag") {
  TestWorld w(settings());
  RopeDef d = rope_between(Vec3(-1, 0, 0), Vec3(1, 0.4, 0));
  d.slack = 1.25;
  d.segments = 40;
  const std::vector<Vec3> reference =
      hanging_points(Vec3(-1, 0, 0), Vec3(1, 0.4, 0), Vec3(0, -1, 0), 1.25, 40);
  Weave weave = made(weave_rope(d));
  for (size_t i = 0; i < weave.particles.size(); ++i)  // from another shape of about its length
    weave.particles[i].x += 0.1 * Vec3(0, std::sin(0.4 * double(i)), std::sin(0.3 * double(i)));
  const Woven woven = add_weave(w, std::move(weave));
  add_air(w, 2);
  w.run(10);
  const ParticleSystem& p = *w->particles(woven.system);
  double sag = 0, error = 0;
  for (size_t i = 0; i < p.size(); ++i) {
    sag = std::max(sag, -reference[i + 1].y());
    error = std::max(error, (p.x[i] - reference[i + 1]).norm());
  }
  CHECK(sag > 0.4);
  CHECK(error < 0.01 * sag);
}

TEST_CASE("a hanging sheet is longer by rho g L^2 / 2E" * doctest::test_suite("long")) {
  for (const double shear : {0.0, 60.0})
    for (const int n : {11, 21}) {
      TestWorld w(settings());
      ClothDef d;
      d.sheet.across = Vec3(0.5, 0, 0);
      d.sheet.down = Vec3(0, -1, 0);
      d.sheet.columns = (n + 1) / 2;
      d.sheet.rows = n;
      d.density = 0.3;
      d.stretch = 200;
      d.shear = shear;
      for (int c = 0; c < d.sheet.columns; ++c) {
        WeavePin pin{0, c, {}};
        pin.anchor.point = Vec3(0.5 * c / (d.sheet.columns - 1), 0, 0);
        d.sheet.pins.push_back(pin);
      }
      const Woven woven = add_weave(w, made(weave_cloth(d)));
      add_air(w, 5);
      w.run(4);
      const ParticleSystem& p = *w->particles(woven.system);
      const size_t middle = p.size() - 1 - size_t(d.sheet.columns) / 2;
      const double longer = -p.x[middle].y() - 1, expected = 0.3 * 9.81 / (2 * 200);
      // With shear the pinned edge keeps its width, which makes the sheet there stiffer.
      CHECK(longer == doctest::Approx(expected).epsilon(shear > 0 ? 0.04 : 1e-3));
    }
}

TEST_CASE("a clamped strip bends by rho g L^4 / 8D, the better the finer it is") {
  double before = 1;
  for (const int n : {5, 9, 17}) {
    TestWorld w(settings());
    ClothDef d;
    const double length = 4, a = length / (n - 1);
    d.sheet.corner = Vec3(-a, 0, 0);
    d.sheet.across = Vec3(length + a, 0, 0);
    d.sheet.down = Vec3(0, 0, 2 * a);
    d.sheet.columns = n + 1;
    d.sheet.rows = 3;
    d.density = 0.3;
    d.stretch = 20000;
    d.shear = 3000;
    d.bend = 1200;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 2; ++c) {
        WeavePin pin{r, c, {}};
        pin.anchor.point = Vec3((c - 1) * a, 0, r * a);
        d.sheet.pins.push_back(pin);
      }
    const Woven woven = add_weave(w, made(weave_cloth(d)));
    add_air(w, 8);
    w.run(4);
    const ParticleSystem& p = *w->particles(woven.system);
    const double expected = 0.3 * 9.81 * std::pow(length, 4) / (8 * 1200);
    const double error = std::fabs(-p.x.back().y() / expected - 1);
    CHECK(error < 0.7 * before);
    before = error;
  }
  CHECK(before < 0.15);
}

TEST_CASE("a hanging chain swings with the period of Bernoulli's closed form") {
  for (const char* stepper : {"realtime", "event"}) {
    const bool exact = std::string(stepper) == "event";
    TestWorld w(settings(stepper, exact ? 600 : 60));
    RopeDef d = rope_between(Vec3::Zero(), Vec3(0, -1, 0), true);
    d.segments = exact ? 20 : 40;
    d.stiffness = exact ? 60 : 1e4;
    d.damping_ratio = 0.02;
    Weave weave = made(weave_rope(d));
    constexpr double j0 = 2.404825557695773;  // first zero of the Bessel function J0
    for (ParticleDef& p : weave.particles) {  // in the first mode, stretched by its own weight
      const double s = -p.x.y(), weight = d.density * 9.81;
      p.x = Vec3(0.01 * std::cyl_bessel_j(0.0, j0 * std::sqrt(std::max(0.0, 1 - s))),
                 -s - weight / d.stiffness * (s - 0.5 * s * s), 0);
    }
    const Woven woven = add_weave(w, std::move(weave));
    // Times at which the lower end passes the middle, in one direction, by linear interpolation.
    const double expected = 4 * std::numbers::pi / j0 * std::sqrt(1 / 9.81);
    std::vector<double> passes;
    double last = 1, h = w->settings().tick.tick();
    const int ticks = int(std::ceil((exact ? 2.2 : 4.2) * expected / h));
    for (int i = 1; i <= ticks; ++i) {
      w.step();
      const double x = w->particles(woven.system)->x.back().x();
      if (last > 0 && x <= 0) passes.push_back(h * (i - x / (x - last)));
      last = x;
    }
    REQUIRE(passes.size() >= 2);
    const double period = (passes.back() - passes.front()) / double(passes.size() - 1);
    CHECK(period == doctest::Approx(expected).epsilon(0.012));
  }
}

TEST_CASE("a thrown cloth keeps its momentum, and gains no energy") {
  for (const double stretch : {100.0, 1e5}) {
    WorldSettings s = settings();
    s.gravity = Vec3::Zero();
    TestWorld w(s);
    ClothDef d = loose_cloth(12);
    d.stretch = stretch;
    d.shear = 0.2 * stretch;
    add_weave(w, crumpled(d, 0.001, 0.3));
    const StepStats start = w->frame()->stats;
    double energy = start.energies.total();
    for (int tick = 0; tick < 200; ++tick) {
      w.step();
      const StepStats now = w->frame()->stats;
      REQUIRE((now.momentum - start.momentum).norm() < 1e-12 * start.momentum.norm());
      REQUIRE((now.angular_momentum - start.angular_momentum).norm() <
              1e-12 * start.angular_momentum.norm());
      energy = now.energies.total();
      REQUIRE(now.energies.kinetic < 1.05 * start.energies.total());
    }
    CHECK(energy < 1.001 * start.energies.total());
  }
}

TEST_CASE("the event stepper keeps momenta of a cloth, and its books close") {
  WorldSettings s = settings("event", 2000);
  s.gravity = Vec3::Zero();
  TestWorld w(s);
  add_weave(w, crumpled(loose_cloth(5), 0.01, 0.3));
  const StepStats start = w->frame()->stats;
  w.run(0.05);
  const auto frame = w->frame();
  CHECK((frame->stats.momentum - start.momentum).norm() < 1e-12 * start.momentum.norm());
  CHECK((frame->stats.angular_momentum - start.angular_momentum).norm() <
        1e-5 * start.angular_momentum.norm());
  CHECK(std::fabs(frame->ledger->line(LedgerLine::integrator).total().balance) <
        1e-3 * frame->ledger->throughput());
}

TEST_CASE("the books of a falling, swinging cloth close") {
  TestWorld w(settings());
  ClothDef d = loose_cloth(12);
  d.bend = 0;
  for (const int c : {0, 11}) {
    WeavePin pin{0, c, {}};
    pin.anchor.point = Vec3(0.5 * c / 11, 0, 0);
    d.sheet.pins.push_back(pin);
  }
  add_weave(w, made(weave_cloth(d)));
  w.run(2);
  const auto frame = w->frame();
  double sum = 0;
  for (size_t k = 0; k < ledger_lines; ++k)
    sum += frame->ledger->line(LedgerLine(k)).total().balance;
  for (const ForceAccount& force : frame->ledger->forces()) sum += force.account.total().balance;
  CHECK(sum == doctest::Approx(frame->stats.energies.total()).epsilon(1e-9));
}

TEST_CASE("a saved cloth goes on as it would have, what loses particles holds together elsewhere") {
  TestWorld w(settings());
  w.ground();
  Weave weave = crumpled(loose_cloth(8), 0.005, 0.2);
  for (ParticleDef& p : weave.particles) p.x.y() += 0.2;
  weave.particles[20].life = 0.5;
  add_weave(w, std::move(weave), true);
  w.run(0.3);
  const Bytes saved = w->save();
  TestWorld other(settings());
  REQUIRE(other->load(saved).ok());
  w.run(0.7);
  other.run(0.7);
  CHECK(w->state_hash() == other->state_hash());
  CHECK(w->frame()->stats.particles == 63);
}

TEST_CASE("a rope breaks where it is stretched too far") {
  TestWorld w(settings());
  RopeDef d = rope_between(Vec3::Zero(), Vec3(0, -1, 0), true);
  d.stiffness = 100;
  Weave weave = made(weave_rope(d));
  weave.particles.back().mass = 1.5;  // 15 N: a strain of 0.15
  const Woven woven = add_weave(w, std::move(weave), false, 0.1);
  const auto links = [&] {
    return std::get<SpringMeshDef>(*w->force(woven.force)).mesh->links.size();
  };
  CHECK(links() == 20);
  w.run(2);
  CHECK(links() < 20);
  CHECK(w->particles(woven.system)->x.back().y() < -5);
}

TEST_CASE("a cloth drapes over a ball and stays there" * doctest::test_suite("long")) {
  TestWorld w(settings());
  w.ground();
  BodyDef ball = TestWorld::sphere_def(Vec3(0, 0.5, 0), 0.3);
  ball.type = BodyType::fixed;
  w.add(ball);
  ClothDef d = loose_cloth(21);
  d.sheet.corner = Vec3(-0.5, 0.85, -0.5);
  d.sheet.across = Vec3(1, 0, 0);
  d.sheet.down = Vec3(0, 0, 1);
  const Woven woven = add_weave(w, made(weave_cloth(d)), true);
  w.run(3);
  const ParticleSystem& p = *w->particles(woven.system);
  double deepest = 0, speed = 0;
  for (size_t i = 0; i < p.size(); ++i) {
    deepest = std::max(deepest, 0.3 + p.radius[i] - (p.x[i] - Vec3(0, 0.5, 0)).norm());
    speed = std::max(speed, p.v[i].norm());
  }
  CHECK(p.x[10 * 21 + 10].y() == doctest::Approx(0.8 + p.radius[0]).epsilon(0.01));
  CHECK(deepest < 0.25 * p.radius[0]);
  CHECK(speed < 0.3);
}

namespace {

/// A cloth that lies flat on the ground, which is a belt of that speed along x, stretched by that
/// share; gives the greatest
/// elastic energy at the end of any tick [J], and the mean velocities along x [m/s].
struct Slide {
  double elastic = 0, left = 0;  ///< at the end of the last tick
  std::vector<double> speed;
};
Slide slide(int hz, double stretch, double friction, double speed, double belt, int ticks,
            double stretched = 0) {
  TestWorld w(settings("realtime", hz));
  BodyDef ground;
  ground.type = BodyType::fixed;
  ShapeDef plane;
  plane.type = ShapeType::half_space;
  Material material;
  material.friction = friction;
  material.surface_velocity = Vec3(belt, 0, 0);
  ground.shapes.push_back({plane, {}, material});
  w.add(ground);
  ClothDef d = loose_cloth(9);
  d.stretch = stretch;
  d.shear = 0.4 * stretch;
  Weave weave = made(weave_cloth(d));
  for (ParticleDef& p : weave.particles) {
    p.x = Vec3((1 + stretched) * p.x.x(), p.radius, p.x.z());
    p.v = Vec3(speed, 0, 0);
  }
  const ParticleSystemId cloth = add_weave(w, std::move(weave), true, 0, friction).system;
  Slide out;
  for (int tick = 0; tick < ticks; ++tick) {
    w.step();
    out.left = w->frame()->stats.energies.springs;
    out.elastic = std::max(out.elastic, out.left);
    double sum = 0;
    for (const Vec3& v : w->particles(cloth)->v) sum += v.x();
    out.speed.push_back(sum / double(w->particles(cloth)->size()));
  }
  return out;
}

}  // namespace

TEST_CASE("a cloth slides over the ground as a block does, and stays flat" *
          doctest::test_suite("long")) {
  // It has about 0.03 J of kinetic energy at 1 m/s, of which waves would make elastic energy.
  for (const int hz : {60, 240, 960})
    for (const double stretch : {20.0, 200.0, 5000.0})
      for (const double friction : {0.05, 0.4}) {
        CAPTURE(hz);
        CAPTURE(stretch);
        CAPTURE(friction);
        const int ticks = hz / 4;
        const Slide s = slide(hz, stretch, friction, 1, 0, ticks);
        CHECK(s.elastic < 1e-6);
        for (int tick = 2; tick < ticks; ++tick) {
          const double left = std::max(0.0, 1 - friction * 9.81 * (tick + 1) / hz);
          CHECK(s.speed[size_t(tick)] == doctest::Approx(left).epsilon(0.02));
        }
      }
}

TEST_CASE("a belt takes a cloth along by friction until it moves as the belt does") {
  for (const int hz : {60, 240}) {
    CAPTURE(hz);
    const double friction = 0.4, belt = 1;
    const int ticks = hz / 2;
    const Slide s = slide(hz, 200, friction, 0, belt, ticks);
    CHECK(s.elastic < 1e-6);
    for (int tick = 2; tick < ticks; ++tick) {
      const double reached = std::min(belt, friction * 9.81 * (tick + 1) / hz);
      CHECK(s.speed[size_t(tick)] == doctest::Approx(reached).epsilon(0.02));
    }
  }
}

TEST_CASE("a belt that moves holds a stretched cloth as ground at rest does") {
  // The laws of motion are the same in both frames. Stretched so far the edges slip until friction
  // holds the rest.
  const double stretch = 5000, stretched = 1e-4;
  const Slide still = slide(240, stretch, 0.8, 0, 0, 60, stretched);
  for (const double belt : {1.0, -3.0}) {
    CAPTURE(belt);
    const Slide moving = slide(240, stretch, 0.8, belt, belt, 60, stretched);
    CHECK(moving.elastic == doctest::Approx(still.elastic).epsilon(1e-3));
    CHECK(moving.left == doctest::Approx(still.left).epsilon(1e-3));
    CHECK(moving.speed.back() == doctest::Approx(belt).epsilon(1e-6));
  }
}
