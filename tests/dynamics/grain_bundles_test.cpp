// Contacts of grains in bundles. References: the definition of a colouring, checked contact by
// contact; conserved sums of a heap in free flight; the same heap on every instruction set.
#include "engine/core/hash.hpp"
#include "engine/core/random.hpp"
#include "engine/dynamics/grains/grain_stage.hpp"
#include "tests/support/scale.hpp"
#include "tests/support/why_not.hpp"

#include <algorithm>
#include <numbers>
#include <set>

#include <doctest/doctest.h>
#include <hwy/targets.h>

using namespace tumble;
using test::scale_is_set;

namespace {

/// A lattice of grains of two sizes without gravity, each with a velocity of its own.
struct Cloud {
  HandlePool<ParticleSystemTag> ids;
  std::vector<ParticleSystem> systems;
  BodySet bodies;
  RealtimeSettings settings;
  Crew crew;
  Vec3 gravity = Vec3::Zero();
  double h = 1.0 / 60;
  GrainTouches touches;
  GrainReport report;

  Cloud(int across, double speed, double restitution, int threads) : crew(threads) {
    settings.sleeping = false;
    ParticleSystemDef d;
    d.name = "cloud";
    d.grains = GrainDef{0.1, 0.05};
    d.friction = 0.5;
    d.restitution = restitution;
    ids.allocate();
    systems.push_back(make_particle_system(d));
    Random random(7);
    for (int n = 0; n < across * across * across; ++n) {
      const double r = random.uniform(0.008, 0.01);
      ParticleDef p;
      p.radius = r;
      p.mass = 2600 * 4.0 / 3 * std::numbers::pi * r * r * r;
      p.x = 0.0195 * Vec3(n % across, n / across % across, n / across / across);
      const Vec3 off{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
      p.v = speed * off;
      systems[0].add(p);
    }
  }
  GrainTick tick() { return {systems, ids, bodies, {}, gravity, h, settings, &crew}; }
  uint64_t hash() const {
    const ParticleSystem& p = systems[0];
    const auto bytes = [](const std::vector<Vec3>& v, uint64_t seed) {
      return hash_bytes(v.data(), v.size() * sizeof(Vec3), seed);
    };
    return bytes(p.spin, bytes(p.v, bytes(p.x, 0)));
  }
  uint64_t run(int ticks) {
    GrainStage stage;
    for (int n = 0; n < ticks; ++n) {
      touches.begin_tick();
      const Status done = stage.step(tick(), touches, report);
      REQUIRE_MESSAGE(done.ok(), test::why_not(done));
    }
    return hash();
  }
};

}  // namespace

TEST_CASE("every pair has one lane, no two of a colour share a grain, no two blocks share any") {
  Cloud cloud(14, 0.1, 0, 1);
  // One large grain that more than 64 others touch.
  ParticleDef large;
  large.radius = 0.06;
  large.mass = 2;
  large.x = 0.0195 * Vec3(7, 7, 7);
  cloud.systems[0].add(large);
  const GrainTick tick = cloud.tick();
  GrainField grains;
  REQUIRE(grains.gather(tick).ok());
  REQUIRE(grains.size() > 2 * grain_block);
  GrainPairs finder;
  GrainPairList pairs;
  REQUIRE(finder.find(tick, grains, tick.h, pairs).ok());
  // Pairs that touch, each once, by brute force.
  size_t touching = 0;
  for (size_t i = 0; i < grains.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      touching += (grains.points[i].x - grains.points[j].x).norm() <=
                  grains.points[i].radius + grains.points[j].radius;
  size_t found = 0;
  std::set<std::pair<uint32_t, uint32_t>> once;
  for (const GrainPair& p : pairs.all) {
    CHECK(grains.key[p.a] < grains.key[p.b]);
    CHECK(once.emplace(p.a, p.b).second);
    found += (grains.points[p.a].x - grains.points[p.b].x).norm() <=
             grains.points[p.a].radius + grains.points[p.b].radius;
  }
  CHECK(found == touching);

  GrainBundles bundles;
  bundles.lay_out(pairs, grains, nullptr);
  std::vector<GrainForces> nothing(pairs.all.size());
  bundles.fill(tick, pairs, grains, nothing, tick.h);
  size_t lanes = 0;
  const auto check = [&](const GrainBundle& c, std::set<uint32_t>& used) {
    lanes += c.lanes;
    for (size_t k = 0; k < c.lanes; ++k) {
      CHECK(once.erase({c.a[k], c.b[k]}) == 1);
      CHECK(used.insert(c.a[k]).second);
      CHECK(used.insert(c.b[k]).second);
    }
  };
  for (size_t b = 0; b < bundles.blocks(); ++b)
    for (uint32_t k = bundles.block(b).begin; k < bundles.block(b).end; ++k) {
      std::set<uint32_t> used;
      check(bundles.all()[k], used);
      for (const uint32_t i : used) CHECK(i / grain_block == b);
    }
  for (const GrainRange& colour : bundles.between()) {
    std::set<uint32_t> used;
    for (uint32_t k = colour.begin; k < colour.end; ++k) check(bundles.all()[k], used);
  }
  CHECK(lanes == pairs.all.size());
  CHECK(once.empty());
}

TEST_CASE("a cloud of thousands of grains keeps its momentum to single precision" *
          doctest::test_suite("long")) {
  for (const double restitution : {0.0, 0.5}) {
    Cloud cloud(16, 0.5, restitution, 2);
    const ParticleSystem& p = cloud.systems[0];
    const auto momentum = [&] {
      Vec3 sum = Vec3::Zero();
      for (size_t i = 0; i < p.size(); ++i) sum += p.mass[i] * p.v[i];
      return sum;
    };
    double all = 0;
    for (size_t i = 0; i < p.size(); ++i) all += p.mass[i] * p.v[i].norm();
    const Vec3 before = momentum();
    cloud.run(30);
    CHECK(cloud.report.contacts > 1000);
    CHECK((momentum() - before).norm() < 1e-6 * all);
  }
}

TEST_CASE("every instruction set gives a cloud of grains the same bits") {
  const int ticks = scale_is_set() && !test::all_counts() ? 2 : 8;
  const uint64_t best = Cloud(12, 0.5, 0.3, 1).run(ticks);
  int targets = 0;
  for (int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
    const int64_t target = left & -left;
    CAPTURE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    CHECK(Cloud(12, 0.5, 0.3, 1).run(ticks) == best);
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    ++targets;
  }
  CHECK(targets > 0);
}
