// Ticks that are cancelled. Reference: the same world, never cancelled; and the bytes of the world
// before the tick; and how often the work looks whether it is to stop, after it was told to.
#include "engine/core/random.hpp"
#include "engine/core/stop.hpp"
#include "engine/dynamics/forces/weave.hpp"
#include "engine/dynamics/particles/fluid_def.hpp"
#include "engine/math/rotation.hpp"
#include "tests/support/ring_mesh.hpp"
#include "tests/support/test_world.hpp"
#include "tests/support/why_not.hpp"

#include <chrono>
#include <functional>
#include <thread>

using namespace tumble;
using namespace tumble::test;

namespace {

WorldSettings settings_of(const char* stepper, const char* broad_phase = "uniform_grid") {
  WorldSettings s;
  s.stepper = stepper;
  s.broad_phase = broad_phase;
  return s;
}

/// A column of blocks with one that is pulled out of it: events without end.
void add_pulled_column(TestWorld& w, int blocks) {
  w.ground();
  BodyId pulled;
  for (int k = 0; k < blocks; ++k) {
    BodyDef def = TestWorld::box_def({0, 0.15 + 0.3 * k, 0}, {0.3, 0.15, 0.3});
    def.pose.q = axis_angle(Vec3::UnitY(), 0.19 * k);
    def.shapes[0].material.friction = 0.6;
    const BodyId id = w.add(def);
    if (k == blocks / 2) pulled = id;
  }
  MouseSpringDef pull;
  pull.anchor.kind = Anchor::Kind::body;
  pull.anchor.body = pulled;
  pull.anchor.point = Vec3(-0.2, 0, 0.3);
  pull.target = Vec3(-1.2, 0.3 * blocks / 2, 0.3);
  pull.frequency = 2;
  pull.max_weights = 10;
  w.force(pull);
}

ShapeDef ring_shape() {
  ShapeDef shape;
  shape.type = ShapeType::triangle_mesh;
  shape.mesh = std::make_shared<const TriangleMesh>(ring_mesh(0.16, 0.06, 12, 6));
  return shape;
}

/// Boxes, balls, rings of triangles, falling on each other, one of them fast; and
/// particles that are looked at.
void add_heap(TestWorld& w, int count) {
  w.ground();
  for (int i = 0; i < count; ++i) {
    const Vec3 x(0.5 * (i % 3), 0.4 + 0.45 * double(i / 9), 0.5 * (i / 3 % 3));
    BodyDef def = i % 3 == 0   ? TestWorld::box_def(x, {0.2, 0.15, 0.2})
                  : i % 3 == 1 ? TestWorld::sphere_def(x, 0.2)
                               : TestWorld::shape_def(ring_shape(), x);
    def.velocity = Vec3(0.2 * (i % 2), -1, 0.1 * (i % 4));
    if (i == count - 1) def.velocity = Vec3(-60, -20, 0);
    w.add(def);
  }
  ParticleSystemDef dust;
  dust.name = "dust";
  dust.fast = true;
  dust.collide = true;
  dust.detect = true;
  for (int i = 0; i < 30; ++i) {
    ParticleDef p;
    p.x = Vec3(0.1 * (i % 6), 1.5 + 0.02 * i, 0.1 * (i % 5));
    p.v = Vec3(0, -3, 0);
    p.mass = 0.01;
    p.radius = 0.02;
    dust.particles.push_back(p);
  }
  REQUIRE(w->create_particles(dust).ok());
  w.apply();
}

ParticleSystemId add_system(TestWorld& w, const ParticleSystemDef& def) {
  const auto id = w->create_particles(def);
  REQUIRE_MESSAGE(id.ok(), test::why_not(id));
  w.apply();
  return *id;
}

/// A block of particles, side by side, which fall.
ParticleSystemDef block_of(int side, double spacing, const Vec3& corner) {
  ParticleSystemDef def;
  for (int i = 0; i < side * side * side; ++i) {
    ParticleDef p;
    p.x = corner + spacing * Vec3(i % side, i / side % side, i / side / side);
    p.v = Vec3(0, -1, 0);
    p.mass = 1000 * spacing * spacing * spacing;
    p.radius = 0.5 * spacing;
    def.particles.push_back(p);
  }
  return def;
}

void add_fluid(TestWorld& w, FluidSolverKind solver) {
  w.ground();
  ParticleSystemDef def = block_of(5, 0.1, {0, 0.06, 0});
  FluidDef fluid;
  fluid.solver = solver;
  fluid.viscosity = 0.5;
  fluid.surface_tension = 0.05;
  def.collide = false;
  def.fluid = std::make_shared<const FluidDef>(fluid);
  add_system(w, def);
  BodyDef box = TestWorld::box_def({0.2, 0.8, 0.2}, {0.1, 0.1, 0.1});
  w.add(box);
}

void add_grains(TestWorld& w) {
  w.ground();
  ParticleSystemDef def = block_of(7, 0.021, {0, 0.011, 0});
  for (ParticleDef& p : def.particles) p.radius = 0.01;
  def.grains = GrainDef{};
  add_system(w, def);
  w.add(TestWorld::box_def({0.07, 0.25, 0.07}, {0.05, 0.05, 0.05}));
}

/// A lump of particles on springs, which falls.
void add_lump(TestWorld& w, int side) {
  ParticleSystemDef lump = block_of(side, 0.05, {0.2, 0.6, 0.2});
  for (ParticleDef& p : lump.particles) p.radius = 0.015;
  const ParticleSystemId id = add_system(w, lump);
  const auto particle = [&](uint64_t i) {
    return Anchor{Anchor::Kind::particle, {}, id, i + 1, Vec3::Zero()};
  };
  for (uint64_t i = 0; i < lump.particles.size(); ++i)
    for (uint64_t k = i + 1; k < lump.particles.size(); ++k) {
      const double apart = (lump.particles[i].x - lump.particles[k].x).norm();
      if (apart > 0.08) continue;
      SpringDef spring;
      spring.a = particle(i), spring.b = particle(k);
      spring.stiffness = 2000;
      spring.rest_length = apart;
      REQUIRE(w->create_force(spring).ok());
    }
  w.apply();
}

/// A cloth over a ball, and a lump of particles on springs that falls on it.
void add_nets(TestWorld& w) {
  w.ground();
  BodyDef ball = TestWorld::sphere_def({0.25, 0.3, 0.25}, 0.2);
  ball.type = BodyType::fixed;
  w.add(ball);
  ClothDef d;
  d.sheet.corner = {0, 0.53, 0};
  d.sheet.across = {0.5, 0, 0};
  d.sheet.down = {0, 0, 0.5};
  d.sheet.columns = d.sheet.rows = 12;
  auto weave = weave_cloth(d);
  REQUIRE(weave.ok());
  ParticleSystemDef cloth;
  cloth.particles = weave->particles;
  w.force(tie(std::move(*weave), add_system(w, cloth), 1));
  add_lump(w, 4);
}

void add_emitters(TestWorld& w) {
  w.ground();
  ParticleSystemDef dust;
  dust.fast = true;
  const ParticleSystemId id = add_system(w, dust);
  EmitterDef jet;
  jet.particles = id;
  jet.pose.x = {0, 0.3, 0};
  jet.rate = 5000;
  jet.life = {0.2};
  jet.speed = {3};
  jet.spread = 3;
  REQUIRE(w->create_emitter(jet).ok());
  w.apply();
}

using Build = std::function<void(TestWorld&)>;

struct Case {
  const char* name;
  WorldSettings settings;
  Build build;
  int ticks;
};

std::vector<Case> cases() {
  return {
      {"event, pulled column", settings_of("event"), [](TestWorld& w) { add_pulled_column(w, 4); },
       6},
      {"event, heap", settings_of("event", "multi_level_grid"),
       [](TestWorld& w) { add_heap(w, 6); }, 3},
      {"realtime, heap", settings_of("realtime", "aabb_tree"),
       [](TestWorld& w) { add_heap(w, 30); }, 12},
      {"realtime, every pair compared", settings_of("realtime", "brute_force"),
       [](TestWorld& w) { add_heap(w, 12); }, 6},
      {"realtime, large island", settings_of("realtime"), [](TestWorld& w) { add_heap(w, 90); }, 8},
      {"fluid, dfsph", settings_of("realtime"),
       [](TestWorld& w) { add_fluid(w, FluidSolverKind::dfsph); }, 4},
      {"fluid, wcsph", settings_of("event"),
       [](TestWorld& w) { add_fluid(w, FluidSolverKind::wcsph); }, 3},
      {"grains", settings_of("realtime"), add_grains, 8},
      {"cloth and net", settings_of("realtime"), add_nets, 12},
      {"event, net", settings_of("event"), [](TestWorld& w) { add_lump(w, 2); }, 3},
      {"emitters", settings_of("realtime"), add_emitters, 6}};
}

/// Looks that a tick takes.
int64_t count_looks(World& world, StopFlag& flag) {
  constexpr int64_t plenty = int64_t{1} << 40;
  flag.request_after(plenty);
  REQUIRE(world.step().ok());
  const int64_t looks = plenty - flag.looks_left();
  flag.clear();
  return looks;
}

}  // namespace

TEST_CASE("a tick that is cancelled anywhere leaves the world as it was") {
  for (const Case& c : cases()) {
    CAPTURE(c.name);
    TestWorld never(c.settings, 1, "stopped by an impulse"), often(c.settings, 1, "by an impulse");
    c.build(never);
    c.build(often);
    StopFlag watch, flag;
    never->stop_with(&watch);
    often->stop_with(&flag);
    Random random(11);
    int64_t most = 0, worst = 0;
    for (int tick = 0; tick < c.ticks; ++tick) {
      const int64_t looks = count_looks(*never.world, watch);
      most = std::max(most, looks);
      const Bytes before = often->save(false);
      const uint64_t hash = often->state_hash();
      for (int k = 0; k < scaled(8); ++k) {
        // The first look of all, the last, and some between.
        const int64_t at = k == 0   ? 0
                           : k == 1 ? looks - 1
                                    : int64_t(random.uniform() * double(looks));
        CAPTURE(at);
        flag.request_after(at);
        const auto report = often->step();
        REQUIRE_FALSE(report.ok());
        CHECK(report.error().code == ErrorCode::cancelled);
        CHECK(often->tick() == uint64_t(tick));
        CHECK(often->state_hash() == hash);
        CHECK(often->save(false) == before);
        CHECK(often->frame()->tick == uint64_t(tick));
        // Every loop ends where it is: what is asked from there on is asked by those around it.
        worst = std::max(worst, -flag.looks_left());
      }
      flag.clear();
      REQUIRE(often->step().ok());
      CHECK(often->state_hash() == never->state_hash());
      CHECK(often->save(false) == never->save(false));
    }
    CHECK(most > 20);  // it can be stopped in its midst
    CHECK(worst < 100);
    MESSAGE(std::string(c.name), ": ", most, " looks a tick, ", worst, " after a request");
  }
}

TEST_CASE("another thread cancels ticks at any time" * doctest::test_suite("long")) {
  using Clock = std::chrono::steady_clock;
  for (const Case& c : cases()) {
    CAPTURE(c.name);
    for (const int threads : {1, 3}) {
      TestWorld never(c.settings, threads, "by an impulse"),
          often(c.settings, threads, "by an impulse");
      c.build(never);
      c.build(often);
      StopFlag flag;
      often->stop_with(&flag);
      Random random(7);
      for (int tick = 0; tick < c.ticks; ++tick) {
        const auto start = Clock::now();
        never.step();
        const auto whole = Clock::now() - start;
        const uint64_t hash = often->state_hash();
        for (int k = 0; k < scaled(3); ++k) {
          const auto wait = std::chrono::duration_cast<Clock::duration>(random.uniform() * whole);
          std::thread other([&] {
            std::this_thread::sleep_for(wait);
            flag.request();
          });
          const auto report = often->step();
          other.join();
          flag.clear();
          // Who is late has not cancelled it: the same tick comes from the world that has not.
          if (report.ok()) break;
          CHECK(report.error().code == ErrorCode::cancelled);
          CHECK(often->state_hash() == hash);
        }
        if (often->tick() == uint64_t(tick)) REQUIRE(often->step().ok());
        CHECK(often->state_hash() == never->state_hash());
      }
    }
  }
}

TEST_CASE("while a request to stop stands no tick is begun, and commands wait") {
  TestWorld w;
  w.ground();
  const BodyId ball = w.sphere({0, 1, 0});
  StopFlag flag;
  w->stop_with(&flag);
  flag.request();
  REQUIRE(w->set_velocity(ball, Vec3(1, 0, 0), Vec3::Zero()).ok());
  const uint64_t hash = w->state_hash();
  const auto report = w->step();
  REQUIRE_FALSE(report.ok());
  CHECK(report.error().code == ErrorCode::cancelled);
  CHECK(w->state_hash() == hash);
  flag.clear();
  w.step();
  CHECK(w.body(ball).v.x() == doctest::Approx(1));
  w->stop_with(nullptr);
  flag.request();
  w.step();
  CHECK(w->tick() == 2);
}
