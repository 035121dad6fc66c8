// Grains in a world. References: the same world with other numbers of threads, or loaded from a
// snapshot; the books' own balance; under the event stepper the same particles without the mark.
#include "engine/core/random.hpp"
#include "tests/support/test_world.hpp"
#include "tests/support/why_not.hpp"

#include <doctest/doctest.h>

using namespace tumble;
using test::TestWorld;

namespace {

WorldSettings realtime() {
  WorldSettings s;
  s.stepper = "realtime";
  return s;
}

ParticleSystemDef heap(int across, int layers) {
  ParticleSystemDef def;
  def.name = "sand";
  def.grains = GrainDef{0.1, 0.05};
  def.restitution = 0.2;
  Random random(2);
  for (int y = 0; y < layers; ++y)
    for (int x = 0; x < across; ++x)
      for (int z = 0; z < across; ++z) {
        ParticleDef p;
        p.radius = random.uniform(0.008, 0.01);
        p.mass = 1e4 * p.radius * p.radius * p.radius;
        p.x = {0.021 * (x - 0.5 * across) + random.uniform(-1e-3, 1e-3), 0.012 + 0.021 * y,
               0.021 * (z - 0.5 * across)};
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

/// A heap on the ground, a box that falls into it, and a paddle that goes through it.
void fill(TestWorld& w) {
  w.ground();
  add(w, heap(7, 6));
  w.box({0, 0.3, 0}, {0.03, 0.03, 0.03});
  BodyDef paddle = TestWorld::box_def({-0.2, 0.05, 0}, {0.01, 0.05, 0.1});
  paddle.type = BodyType::kinematic;
  paddle.velocity = {0.3, 0, 0};
  w.add(paddle);
}

}  // namespace

TEST_CASE("grains: one, two and four threads give the same state" * doctest::test_suite("long")) {
  uint64_t hash = 0;
  for (const int threads : {1, 2, 4}) {
    TestWorld w(realtime(), threads);
    fill(w);
    w.run(1);
    if (threads == 1) hash = w->state_hash();
    CHECK(w->state_hash() == hash);
  }
}

TEST_CASE("grains: a loaded snapshot has the same future, moving and asleep") {
  TestWorld w(realtime());
  w.ground();
  add(w, heap(5, 4));
  for (int n = 0; n < 300; ++n) {
    if (n % 23 != 0) {
      w.step();
      continue;
    }
    WorldDef def;
    def.threads = 1;
    auto copy = World::create(std::move(def));
    REQUIRE(copy.ok());
    REQUIRE((*copy)->load(w->save()).ok());
    CHECK((*copy)->state_hash() == w->state_hash());
    w.step();
    REQUIRE((*copy)->step().ok());
    CHECK((*copy)->state_hash() == w->state_hash());
  }
}

TEST_CASE("grains: the books close, whatever pushes them") {
  TestWorld w(realtime());
  fill(w);
  w.force(LinearDragDef{0.01, 0.01});
  w.run(2);
  const auto frame = w->frame();
  const Ledger& ledger = *frame->ledger;
  // The load that carries a body over to the next tick is booked along the chord of its way.
  CHECK(ledger.drift() < 5e-3);
  CHECK(ledger.line(LedgerLine::friction).total().balance < 0);
  CHECK(ledger.line(LedgerLine::restitution).total().balance < 0);
}

TEST_CASE("grains: a box lies on them, and both come to rest") {
  TestWorld w(realtime());
  w.ground();
  add(w, heap(10, 4));
  const BodyId box = w.box({0, 0.16, 0}, {0.05, 0.03, 0.05});
  w.run(3);
  const double y = w.body(box).pose.x.y();
  CHECK(y > 0.05);
  w.run(1);
  CHECK(w.body(box).pose.x.y() == doctest::Approx(y).epsilon(0.02));
}

TEST_CASE("grains: the statistics count what presses, moving and asleep") {
  TestWorld w(realtime());
  w.ground();
  // A column of four: three contacts of two grains, and one with the ground.
  ParticleSystemDef def;
  def.name = "column";
  def.grains = GrainDef{0.1, 0.05};
  for (int k = 0; k < 4; ++k) {
    ParticleDef p;
    p.radius = 0.01;
    p.mass = 0.01;
    p.x = {0, 0.01 + 0.02 * k, 0};
    def.particles.push_back(p);
  }
  add(w, def);
  // And a box on the ground, which has contacts of its own.
  w.box({1, 0.1, 0}, {0.1, 0.1, 0.1});
  w.run(0.2);
  CHECK(w->frame()->stats.contacts == 5);
  CHECK(w->frame()->stats.contact_points == 8);
  CHECK(w->frame()->contacts->size() == 4);
  w.run(4);
  CHECK(w->frame()->stats.contacts == 5);
  CHECK(w->frame()->stats.contact_points == 8);
}

TEST_CASE("grains: what loses its floor falls") {
  TestWorld w(realtime());
  const BodyId floor = w.ground();
  add(w, heap(4, 3));
  w.run(4);
  const double before = w->frame()->stats.energies.gravity;
  CHECK(w->destroy_body(floor).ok());
  w.run(0.5);
  CHECK(w->frame()->stats.energies.gravity < before - 0.1);
}

TEST_CASE("grains are particles like others under the event stepper") {
  WorldSettings settings;
  settings.stepper = "event";
  double height[2];
  for (const bool grains : {true, false}) {
    TestWorld w(settings);
    w.ground();
    ParticleSystemDef def = heap(2, 2);
    if (!grains) def.grains.reset();
    add(w, def);
    w.run(0.3);
    height[grains] = w->frame()->stats.energies.gravity;
  }
  CHECK(height[0] == height[1]);
}
