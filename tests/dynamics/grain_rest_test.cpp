// Which grains go to sleep. Reference: the definition, asked of every grain about every contact.
#include "engine/dynamics/grains/grain_rest.hpp"

#include "engine/core/random.hpp"
#include "tests/dynamics/grain_cloud.hpp"

#include <algorithm>
#include <limits>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

/// Grains at rest anywhere, slow for up to twice the time of sleep, a tenth of them asleep; any two
/// that are near touch, of which two thirds press.
struct RestingCloud : test::GrainCloud {
  GrainPairs finder;
  GrainPairList pairs;
  std::vector<GrainForces> forces;
  std::vector<Vec3> start;

  explicit RestingCloud(int threads) : GrainCloud(threads) {
    Random random(3);
    for (int n = 0; n < 3000; ++n) {
      const double radius = random.uniform(0.008, 0.01);
      const Vec3 x(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1));
      GrainRest& rest = add(x, Vec3::Zero(), radius);
      rest.time = random.uniform(0.4, 2) * settings.sleep_time;
      if (random.uniform(0, 1) < 0.1) rest.time = std::numeric_limits<double>::infinity();
      if (random.uniform(0, 1) < 0.02) rest.time = 0;
    }
    gather();
    REQUIRE(finder.find(tick(), grains, h, pairs).ok());
    forces.resize(pairs.all.size());
    for (GrainForces& f : forces) f.push = random.uniform(0, 3) < 2 ? 1 : 0;
    for (const GrainPoint& p : grains.points) start.push_back(p.x);
  }
  double slow_for(size_t i) const {
    return systems[0].rest[grains.owner[i].index].time + (grains.asleep[i] ? 0 : h);
  }
  /// By its definition, before the tick ends.
  bool falls_asleep(uint32_t i) const {
    if (grains.asleep[i] || slow_for(i) < settings.sleep_time) return false;
    bool touches = false;
    for (size_t k = 0; k < pairs.all.size(); ++k) {
      const auto [a, b] = pairs.all[k];
      if (forces[k].push == 0 || (a != i && b != i)) continue;
      if (slow_for(a == i ? b : a) < 0.5 * settings.sleep_time) return false;
      touches = true;
    }
    return touches;
  }
};

}  // namespace

TEST_CASE("grains fall asleep that have been slow and touch only what has, on any threads") {
  for (const int threads : {1, 3}) {
    CAPTURE(threads);
    RestingCloud cloud(threads);
    std::vector<uint8_t> sleeps(cloud.grains.size());
    for (uint32_t i = 0; i < cloud.grains.size(); ++i)
      sleeps[i] = cloud.grains.asleep[i] || cloud.falls_asleep(i);
    const auto expected = size_t(std::ranges::count(sleeps, 1));
    // Some of each kind: asleep before, now, and kept awake by what they touch.
    size_t kept_awake = 0;
    for (uint32_t i = 0; i < cloud.grains.size(); ++i)
      kept_awake += !sleeps[i] && cloud.slow_for(i) >= cloud.settings.sleep_time;
    CHECK(expected > cloud.grains.sleepers + 300);
    CHECK(kept_awake > 300);
    GrainRestWatch watch;
    GrainReport report;
    cloud.crew.gather([&] {
      watch.watch(cloud.tick(), cloud.grains, cloud.start, cloud.pairs, cloud.forces, GrainBodies(),
                  report);
    });
    CHECK(cloud.grains.sleepers == expected);
    for (uint32_t i = 0; i < cloud.grains.size(); ++i)
      CHECK(cloud.systems[0].rest[cloud.grains.owner[i].index].asleep() == (sleeps[i] != 0));
  }
}
