// Particle systems that are fluids, in worlds. References: conserved momenta, the books' own
// balance, the same state by another way (threads, snapshots, ticks that fail).
#include "engine/dynamics/particles/fluid_def.hpp"
#include "tests/support/test_world.hpp"
#include "tests/support/why_not.hpp"

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
  REQUIRE_MESSAGE(id.ok(), test::why_not(id));
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
        REQUIRE_MESSAGE(ok.ok(), test::why_not(ok));
      }
      for (TestWorld* w : {&one, &two, &four}) w->step();
      if (n >= 7) loaded.step();
    }
    CHECK(one->state_hash() == two->state_hash());
    CHECK(one->state_hash() == four->state_hash());
    CHECK(one->state_hash() == loaded->state_hash());
  }
}

TEST_CASE("fluids: momentum of a fluid and a free body is kept without gravity" *
          doctest::test_suite("long")) {
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

TEST_CASE("fluids: the books close" * doctest::test_suite("long")) {
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
    // The error of the box's own integrator, which depends on when the water throws it at walls.
    CHECK(std::fabs(rest.balance) < 2e-6 * moved);
  }
}

TEST_CASE("fluids: a tick that fails leaves them as they were") {
  for (const char* stepper : steppers) {
    CAPTURE(stepper);
    ParticleSystemDef fast = water({0.1, 2, 0.2}, 1, 1, 1);
    fast.name = "too fast";
    fast.particles[0].v = {1e9, 0, 0};
    fast.gravity_scale = 0;
    TestWorld other(settings_of(stepper), 1, time_stepped);
    break_dam(other);
    other.run(0.1);
    add(other, std::move(fast));
    const uint64_t before = other->state_hash();
    CHECK_FALSE(other->step().ok());
    CHECK(other->state_hash() == before);
  }
}

TEST_CASE("fluids: of two systems press on each other, and the books of both close" *
          doctest::test_suite("long")) {
  for (const char* stepper : steppers) {
    CAPTURE(stepper);
    TestWorld w(settings_of(stepper), 1, time_stepped);
    break_dam(w);
    // Oil above the water, where it would fall through if it did not see it.
    ParticleSystemDef oil = water({0, 0.5, 0}, 4, 2, 5);
    oil.name = "oil";
    FluidDef light;
    light.density = 600;
    oil.fluid = std::make_shared<const FluidDef>(light);
    for (ParticleDef& p : oil.particles) p.mass *= 0.6;
    const ParticleSystemId id = add(w, std::move(oil));
    w.run(0.5);
    const ParticleSystem& above = *w->particles(id);
    const ParticleSystem& below = *w->particles(w->frame()->particles[0]->id);
    for (const ParticleSystem* p : {&above, &below})
      for (const double density : p->density) CHECK(density < 1.1 * p->fluid->density);
    const Ledger& books = *w->frame()->ledger;
    CHECK(std::fabs(books.line(LedgerLine::integrator).total().balance) <
          1e-6 * books.throughput());
  }
}

TEST_CASE("fluids: one that is two systems moves as one, and others say that they do not") {
  TestWorld one(settings_of("realtime")), two(settings_of("realtime"));
  add(one, water({0, 0, 0}, 4, 4, 4));
  add(two, water({0, 0, 0}, 2, 4, 4));
  ParticleSystemDef rest = water({2 * spacing, 0, 0}, 2, 4, 4);
  rest.name = "rest";
  add(two, std::move(rest));
  for (TestWorld* w : {&one, &two}) {
    BodyDef floor = TestWorld::box_def({0, -0.1, 0}, {10, 0.1, 10});
    floor.type = BodyType::fixed;
    w->add(floor);
    for (int k = 0; k < 10; ++k) w->step();
  }
  std::vector<Vec3> x;
  for (const auto& p : two->frame()->particles) {
    const ParticleSystem& part = *two->particles(p->id);
    x.insert(x.end(), part.x.begin(), part.x.end());
  }
  const ParticleSystem& whole = *one->particles(one->frame()->particles[0]->id);
  REQUIRE(x.size() == whole.size());
  // What a particle's own pressure opens is summed in another order.
  for (size_t i = 0; i < x.size(); ++i) CHECK((x[i] - whole.x[i]).norm() < 1e-6);

  TestWorld apart;
  int said = 0;
  WorldDef logged;
  logged.log = [&said](LogLevel, std::string_view message) {
    said += message.find("'water' and 'wide' do not see each other") != std::string_view::npos;
  };
  apart.world = std::move(*World::create(std::move(logged)));
  add(apart, water({0, 0, 0}, 2, 2, 2));
  ParticleSystemDef wide = water({1, 0, 0}, 2, 2, 2);
  wide.name = "wide";
  FluidDef def;
  def.smoothing = 3;
  wide.fluid = std::make_shared<const FluidDef>(def);
  add(apart, std::move(wide));
  for (int k = 0; k < 2; ++k) apart.step();
  CHECK(said == 1);
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

TEST_CASE("fluids: frames say with what force a fluid is on a body, and how its particles are") {
  TestWorld w(settings_of("realtime"));
  const BodyId box = break_dam(w);
  double down = 0, side = 0;
  const int ticks = 240, counted = 60;
  for (int k = 0; k < ticks; ++k) {
    w.step();
    if (k < ticks - counted) continue;
    // All that it does to the tank and the box: its weight, and nothing sideways once it rests.
    for (const FluidForceFrame& f : w->frame()->fluid_forces) {
      down -= f.force.y() / counted;
      side += f.force.x() / counted;
    }
  }
  const ParticleSystem& fluid = *w->particles(w->frame()->particles[0]->id);
  double mass = 0, speed = 0;
  Vec3 moment = Vec3::Zero(), low = fluid.x[0];
  for (size_t i = 0; i < fluid.size(); ++i) {
    mass += fluid.mass[i];
    moment += fluid.mass[i] * fluid.x[i];
    speed = std::max(speed, fluid.v[i].norm());
    low = low.cwiseMin(fluid.x[i]);
  }
  CHECK(down == doctest::Approx(9.81 * mass).epsilon(0.05));
  CHECK(std::abs(side) < 0.05 * 9.81 * mass);
  CHECK(w->frame()->fluid_force(BodyId{}).force == Vec3::Zero());
  CHECK(w->frame()->fluid_force(box).body == box);
  const ParticleMeasures& m = w->frame()->particles[0]->measures;
  CHECK(m.count == fluid.size());
  CHECK((m.centre - moment / mass).norm() < 1e-12);
  CHECK(m.max_speed == doctest::Approx(speed));
  CHECK(m.low == low);
}

TEST_CASE("temperature is that of the random motion alone") {
  TestWorld w(settings_of("realtime", Vec3::Zero()));
  ParticleSystemDef def;
  def.collide = false;
  // Opposite velocities of 2 m/s along each axis on top of a common one: 4 m/s squared in the mean.
  for (int k = 0; k < 6; ++k) {
    ParticleDef p;
    p.x = {double(k), 0, 0};
    p.mass = 3;
    p.v = Vec3(5, 0, 0) + (k % 2 == 0 ? 2.0 : -2.0) * Vec3::Unit(k / 2);
    def.particles.push_back(p);
  }
  add(w, std::move(def));
  w.step();
  CHECK(w->frame()->particles[0]->measures.temperature ==
        doctest::Approx(2.0 / 3 * 0.5 * 3 * 4).epsilon(1e-12));
}

TEST_CASE("fluids: a body without friction lets a viscous fluid slide") {
  double sliding[2];
  for (const int k : {0, 1}) {
    TestWorld w(settings_of("realtime", {0, -9.81, 0}));
    BodyDef floor = TestWorld::box_def({0, -0.1, 0}, {10, 0.1, 10});
    floor.type = BodyType::fixed;
    floor.fluid_friction = k;
    w.add(floor);
    ParticleSystemDef def = water({-0.3, 0, -0.3}, 6, 2, 6);
    FluidDef thick;
    thick.viscosity = 50;
    thick.wall_friction = 1;
    thick.xsph = 0;
    def.fluid = std::make_shared<const FluidDef>(thick);
    for (ParticleDef& p : def.particles) p.v = {1, 0, 0};
    add(w, std::move(def));
    w.run(0.3);
    sliding[k] = w->frame()->ledger->now().momentum.x() / (1000 * 72 * 1e-3);
  }
  CHECK(sliding[0] == doctest::Approx(1).epsilon(1e-6));
  CHECK(sliding[1] < 0.5);
}
