// Particles of systems that are fast exchange impulses with bodies at the ends of ticks, under
// either stepper. References: closed forms of one collision, of rest and of sliding (the recurrence
// of one velocity a tick), conserved momenta, the books' own balance.
#include "engine/core/random.hpp"
#include "engine/math/rotation.hpp"
#include "tests/support/test_world.hpp"
#include "tests/support/why_not.hpp"

#include <array>
#include <cmath>

using namespace tumble;
using test::scaled;
using test::TestWorld;

namespace {

constexpr double weight = 9.81;
constexpr std::array steppers{"event", "realtime"};

WorldSettings settings_of(const char* stepper, const Vec3& gravity) {
  WorldSettings s;
  s.gravity = gravity;
  s.stepper = stepper;
  s.event.budget = 1000000;  // what is claimed of events is not left to time-stepping
  return s;
}

ParticleDef grain(const Vec3& x, const Vec3& v, double mass = 0.01, double radius = 0.02) {
  ParticleDef p;
  p.x = x, p.v = v, p.mass = mass, p.radius = radius;
  return p;
}

ParticleSystemId add_fast(TestWorld& w, std::vector<ParticleDef> particles, double friction,
                          double restitution) {
  ParticleSystemDef def;
  def.name = "dust";
  def.particles = std::move(particles);
  def.friction = friction;
  def.restitution = restitution;
  def.fast = true;
  const auto id = w->create_particles(std::move(def));
  REQUIRE_MESSAGE(id.ok(), test::why_not(id));
  w.apply();
  return *id;
}

Vec3 drawn(Random& r, double size) {
  return {r.uniform(-size, size), r.uniform(-size, size), r.uniform(-size, size)};
}

BodyId add_slope(TestWorld& w, double tilt, double friction) {
  BodyDef def =
      TestWorld::shape_def({.type = ShapeType::half_space}, Vec3::Zero(), BodyType::fixed);
  def.shapes[0].material.friction = friction;
  def.pose.q = axis_angle(Vec3::UnitZ(), tilt);
  return w.add(def);
}

}  // namespace

TEST_CASE("fast particles: one that strikes a free plank turns it by the closed form's impulse") {
  for (const char* stepper : steppers)
    for (const double e : {0.25, 0.6, 1.0}) {
      CAPTURE(stepper);
      CAPTURE(e);
      TestWorld w(settings_of(stepper, Vec3::Zero()));
      BodyDef plank = TestWorld::box_def(Vec3::Zero(), {1, 0.05, 0.2});
      plank.shapes[0].material.friction = 0;
      const BodyId body = w.add(plank);
      const double m = 5, d = 0.7, v = 4;
      const ParticleSystemId id = add_fast(w, {grain({d, 0.2, 0}, {0, -v, 0}, m, 0.1)}, 0, e);
      w.run(0.05);
      const RigidBody& b = w.body(body);
      const double moment = b.inverse_inertia_body(2, 2);
      const double J = (1 + e) * v / (1 / m + b.inverse_mass + d * d * moment);
      CHECK((w->particles(id)->v[0] - Vec3(0, J / m - v, 0)).norm() < 1e-9);
      CHECK((b.v + J * b.inverse_mass * Vec3::UnitY()).norm() < 1e-9);
      CHECK((b.omega + J * d * moment * Vec3::UnitZ()).norm() < 1e-9);
    }
}

TEST_CASE("fast particles: dust and bodies keep both momenta, and energy only falls") {
  for (const char* stepper : steppers) {
    CAPTURE(stepper);
    Random r(71);
    TestWorld w(settings_of(stepper, Vec3::Zero()));
    const std::array<ShapeDef, 4> shapes{
        {{.type = ShapeType::sphere, .radius = 0.4},
         {.type = ShapeType::box, .half_extents = {0.2, 0.4, 0.3}},
         {.type = ShapeType::cylinder, .radius = 0.3, .height = 0.5},
         {.type = ShapeType::ellipsoid, .half_extents = {0.2, 0.5, 0.3}}}};
    for (size_t k = 0; k < shapes.size(); ++k) {
      BodyDef def = TestWorld::shape_def(shapes[k], 1.5 * Vec3(k & 1 ? 1 : -1, 0, k & 2 ? 1 : -1));
      def.angular_velocity = drawn(r, 1);
      def.can_sleep = false;
      w.add(def);
    }
    std::vector<ParticleDef> dust;
    for (int i = 0; i < 300; ++i) {
      const Vec3 x = Vec3(0, 3, 0) + drawn(r, 2.5);
      dust.push_back(grain(x, Vec3(0, -8, 0) + drawn(r, 2), 1));
    }
    add_fast(w, dust, 0.4, 0.7);
    const auto before = w->frame()->stats;
    double energy = before.energies.total();
    for (int k = 0; k < 60; ++k) {
      w.step();
      const double now = w->frame()->stats.energies.total();
      CHECK(now <= energy * (1 + 1e-9));
      energy = now;
    }
    const auto& after = w->frame()->stats;
    const double scale = 300 * 8;
    CHECK((after.momentum - before.momentum).norm() < 1e-12 * scale);
    // That particles are put where what they met has moved meanwhile is a correction.
    const Ledger& books = *w->frame()->ledger;
    const Vec3 turned = after.angular_momentum - before.angular_momentum;
    const Vec3 corrected = books.line(LedgerLine::projection).total().angular_momentum;
    CHECK((turned - corrected).norm() < 1e-11 * scale);
    CHECK(corrected.norm() < 1e-3 * scale);
    CHECK(books.line(LedgerLine::restitution).total().balance < 0);
    CHECK(books.line(LedgerLine::friction).total().balance < 0);
    CHECK(books.drift() < 1e-6);
  }
}

TEST_CASE("fast particles: on a slope they rest inside the cone, and slide with g (sin - mu cos)") {
  for (const char* stepper : steppers)
    for (const double mu : {0.3, 0.7}) {
      CAPTURE(stepper);
      CAPTURE(mu);
      const double tilt = std::atan(0.5), r = 0.02;
      const Vec3 up(-std::sin(tilt), std::cos(tilt), 0), down(-std::cos(tilt), -std::sin(tilt), 0);
      TestWorld w(settings_of(stepper, {0, -weight, 0}));
      add_slope(w, tilt, mu);
      const ParticleSystemId id = add_fast(w, {grain(r * up, Vec3::Zero())}, mu, 0.5);
      w.run(1);
      const ParticleSystem& p = *w->particles(id);
      const double pull = std::max(0.0, weight * (std::sin(tilt) - mu * std::cos(tilt)));
      CHECK((p.v[0] - pull * down).norm() < 1e-9);
      CHECK(std::fabs(up.dot(p.x[0]) - r) < 1e-5);
      // One velocity a tick: within a tick's way of the parabola.
      CHECK((p.x[0] - r * up - 0.5 * pull * down).norm() < pull / 60 + 1e-5);
    }
}

TEST_CASE("fast particles: none passes a plate of a tenth of a millimetre at 1000 m/s") {
  for (const char* stepper : steppers) {
    CAPTURE(stepper);
    Random r(72);
    TestWorld w(settings_of(stepper, Vec3::Zero()));
    BodyDef plate = TestWorld::box_def(Vec3::Zero(), {2, 5e-5, 2});
    plate.type = BodyType::fixed;
    w.add(plate);
    std::vector<ParticleDef> shots;
    for (int i = 0; i < 100; ++i) {
      const double side = i % 2 ? 1 : -1;
      shots.push_back(grain({r.uniform(-1, 1), side * r.uniform(1, 20), r.uniform(-1, 1)},
                            {r.uniform(-9, 9), -side * 1000, r.uniform(-9, 9)}, 0.001, 1e-3));
    }
    const ParticleSystemId id = add_fast(w, shots, 0.3, 0.5);
    w.run(0.1);
    const ParticleSystem& p = *w->particles(id);
    for (size_t i = 0; i < p.size(); ++i) {
      CHECK(p.x[i].y() * (i % 2 ? 1 : -1) > 0);
      CHECK(std::fabs(p.v[i].y()) == doctest::Approx(500).epsilon(1e-9));
    }
  }
}

TEST_CASE("fast particles: dust that settles does not wake what sleeps, a stone does") {
  TestWorld w(settings_of("realtime", {0, -weight, 0}));
  w.ground();
  BodyDef def = TestWorld::box_def({0, 0.5, 0});
  def.starts_asleep = true;
  const BodyId box = w.add(def);
  const ParticleSystemId dust = add_fast(w, {grain({0, 1.1, 0}, Vec3::Zero(), 1e-4)}, 0.5, 0);
  w.run(2);
  CHECK(w.body(box).asleep);
  CHECK(std::fabs(w->particles(dust)->x[0].y() - 1.02) < 1e-4);
  add_fast(w, {grain({0.3, 1.1, 0}, {0, -30, 0}, 50)}, 0.5, 0);
  w.run(0.05);
  CHECK(!w.body(box).asleep);
}

TEST_CASE("fast particles: the same bits for 1, 2 and 4 threads, and after a snapshot") {
  for (const char* stepper : steppers) {
    std::vector<uint64_t> hashes;
    const auto fill = [](TestWorld& w) {
      Random r(73);
      add_slope(w, 0.1, 0.5);
      for (int i = 0; i < 4; ++i) w.box({1.5 * i - 2, 0.8, 0}, {0.3, 0.2, 0.4});
      std::vector<ParticleDef> dust;
      for (int i = 0; i < 200; ++i) dust.push_back(grain(Vec3(0, 2, 0) + drawn(r, 1), drawn(r, 1)));
      add_fast(w, dust, 0.5, 0.3);
    };
    for (const int threads : {1, 2, 4}) {
      TestWorld w(settings_of(stepper, {0, -weight, 0}), threads);
      fill(w);
      w.run(0.3);
      TestWorld other(settings_of(stepper, {0, -weight, 0}), 1);
      REQUIRE(other->load(w->save()).ok());
      w.run(0.3), other.run(0.3);
      hashes.push_back(w->state_hash());
      CHECK(other->state_hash() == hashes.back());
    }
    CHECK(hashes[1] == hashes[0]);
    CHECK(hashes[2] == hashes[0]);
  }
}
