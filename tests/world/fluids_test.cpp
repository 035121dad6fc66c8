// Particle systems that are fluids, in worlds. References: conserved momenta, the books' own
// balance, the same state by another way (threads, snapshots, ticks that fail).
#include "engine/dynamics/particles/fluid_def.hpp"
#include "tests/support/test_world.hpp"

#include <array>
#include <cmath>

using namespace tumble;
using test::TestWorld;

namespace {

constexpr double spacing = 0.1;
constexpr std::array steppers{"realtime", "event"};
/// Under `event` a box among forces that a fluid changes from tick to tick may have more events
/// than its budget.
constexpr const char* time_stepped = "time-stepping moved them";

ParticleSystemDef water(const Vec3& low, int nx, int ny, int nz) {
  ParticleSystemDef def;
  def.name = "water";
  def.collide = false;
  def.fluid = std::make_shared<const FluidDef>();
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k) {
        ParticleDef p;
        p.x = low + spacing * (Vec3(i, j, k) + Vec3::Constant(0.5));
        p.mass = def.fluid->density * spacing * spacing * spacing;
        p.radius = 0.5 * spacing;
        def.particles.push_back(p);
      }
  return def;
}

ParticleSystemId add(TestWorld& w, ParticleSystemDef def) {
  const auto id = w->create_particles(std::move(def));
  REQUIRE_MESSAGE(id.ok(), (id.ok() ? "" : id.error().text()));
  w.apply();
  return *id;
}

WorldSettings settings_of(const char* stepper, const Vec3& gravity = {0, -9.81, 0}) {
  WorldSettings s;
  s.stepper = stepper;
  s.gravity = gravity;
  return s;
}

/// A column that breaks in a tank 0.8 m by 0.5 m wide, and a light box in its way.
BodyId break_dam(TestWorld& w) {
  const auto wall = [&w](const Vec3& x, const Vec3& half) {
    BodyDef def = TestWorld::box_def(x, half);
    def.type = BodyType::fixed;
    w.add(def);
  };
  wall({0.4, -0.1, 0.25}, {0.6, 0.1, 0.45});
  wall({-0.1, 0.5, 0.25}, {0.1, 0.5, 0.45});
  wall({0.9, 0.5, 0.25}, {0.1, 0.5, 0.45});
  wall({0.4, 0.5, -0.1}, {0.4, 0.5, 0.1});
  wall({0.4, 0.5, 0.6}, {0.4, 0.5, 0.1});
  BodyDef box = TestWorld::box_def({0.62, 0.1, 0.25}, {0.1, 0.1, 0.1});
  box.shapes[0].material.density = 400;
  const BodyId id = w.add(box);
  add(w, water({0, 0, 0}, 4, 5, 5));
  return id;
}

}  // namespace

TEST_CASE("fluids: threads, and a world loaded in between, have the same bits") {
  for (const char* stepper : steppers) {
    CAPTURE(stepper);
    TestWorld one(settings_of(stepper), 1, time_stepped),
        two(settings_of(stepper), 2, time_stepped), four(settings_of(stepper), 4, time_stepped),
        loaded(settings_of(stepper), 1, time_stepped);
    for (TestWorld* w : {&one, &two, &four}) break_dam(*w);
    for (int n = 0; n < 20; ++n) {
      if (n == 7) {
        const Bytes saved = one->save();
        const Status ok = loaded->load(saved);
        REQUIRE_MESSAGE(ok.ok(), (ok.ok() ? "" : ok.error().text()));
      }
      for (TestWorld* w : {&one, &two, &four}) w->step();
      if (n >= 7) loaded.step();
    }
    CHECK(one->state_hash() == two->state_hash());
    CHECK(one->state_hash() == four->state_hash());
    CHECK(one->state_hash() == loaded->state_hash());
  }
}

TEST_CASE("fluids: momentum of a fluid and a free body is kept without gravity") {
  for (const char* stepper : steppers) {
    CAPTURE(stepper);
    TestWorld w(settings_of(stepper, Vec3::Zero()));
    ParticleSystemDef def = water({0, 0, 0}, 5, 5, 5);
    double scale = 0;
    for (ParticleDef& p : def.particles) {
      p.v = {1, 0, 0};
      scale += p.mass;
    }
    add(w, std::move(def));
    BodyDef box = TestWorld::box_def({0.65, 0.25, 0.25}, {0.1, 0.1, 0.1});
    box.shapes[0].material.density = 500;
    const BodyId id = w.add(box);
    w.run(0.3);
    CHECK(w.body(id).v.x() > 0.05);
    const Vec3 momentum = w->frame()->ledger->now().momentum;
    MESSAGE("momentum off by ", (momentum - Vec3(scale, 0, 0)).norm() / scale);
    CHECK((momentum - Vec3(scale, 0, 0)).norm() < 1e-9 * scale);
  }
}

TEST_CASE("fluids: the books close") {
  for (const char* stepper : steppers) {
    CAPTURE(stepper);
    TestWorld w(settings_of(stepper), 1, time_stepped);
    break_dam(w);
    w.run(0.5);
    const Ledger& books = *w->frame()->ledger;
    const LedgerEntry rest = books.line(LedgerLine::integrator).total();
    const double moved = books.throughput();
    MESSAGE("integrator ", rest.work / moved, " ", rest.balance / moved, " of ", moved, " J");
    CHECK(books.line(LedgerLine::sph_pressure).total().work != 0);
    CHECK(std::fabs(rest.balance) < 1e-6 * moved);
  }
}

TEST_CASE("fluids: a tick that fails leaves them as they were") {
  for (const char* stepper : steppers) {
    CAPTURE(stepper);
    ParticleSystemDef fast = water({0.1, 2, 0.2}, 1, 1, 1);
    fast.name = "too fast";
    fast.particles[0].v = {1e9, 0, 0};
    fast.gravity_scale = 0;
    TestWorld other(settings_of(stepper), 1, "do not see each other");
    break_dam(other);
    other.run(0.1);
    add(other, std::move(fast));
    const uint64_t before = other->state_hash();
    CHECK_FALSE(other->step().ok());
    CHECK(other->state_hash() == before);
  }
}

TEST_CASE("fluids: what makes no sense is refused") {
  TestWorld w;
  ParticleSystemDef def = water({0, 0, 0}, 1, 1, 1);
  def.collide = true;
  CHECK_FALSE(w->create_particles(def).ok());
  def.collide = false;
  def.fast = true;
  CHECK_FALSE(w->create_particles(def).ok());
  def.fast = false;
  def.box.size = {1, 1, 1};
  CHECK_FALSE(w->create_particles(def).ok());
}
