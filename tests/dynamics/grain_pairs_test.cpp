// Which grains may touch. Reference: the definition, tried for every two of them.
#include "engine/core/random.hpp"
#include "engine/dynamics/grains/tolerances.hpp"
#include "tests/dynamics/grain_cloud.hpp"

#include <algorithm>
#include <limits>

#include <doctest/doctest.h>
#include <hwy/targets.h>

using namespace tumble;

namespace {

constexpr double part = 1.0 / 120;  // [s]

/// A cloud of grains of many sizes, some fast, all of one half of it asleep.
struct Cloud : test::GrainCloud {
  explicit Cloud(int threads) : GrainCloud(threads) {
    Random random(11);
    const auto anywhere = [&](double most) {
      return Vec3(random.uniform(-most, most), random.uniform(-most, most),
                  random.uniform(-most, most));
    };
    for (int n = 0; n < 1500; ++n) {
      const double radius = random.uniform(0.004, 0.01);
      const Vec3 x = anywhere(0.1), v = anywhere(n % 100 == 0 ? 2 : 0.1);
      GrainRest& rest = add(x, v, radius);
      if (x.x() < 0) rest = {Vec3::Zero(), std::numeric_limits<double>::infinity()};
    }
    gather();
  }
  double distance(size_t i, size_t j) const {
    return (grains.points[j].x - grains.points[i].x).norm();
  }
  bool may_touch(size_t i, size_t j) const {
    const double ri = grains.points[i].radius, rj = grains.points[j].radius, r = std::min(ri, rj);
    const double closing = part * (grains.movers[j].v - grains.movers[i].v).norm();
    return distance(i, j) <= ri + rj + r * tolerances::grain_margin +
                                 std::min(closing, r * tolerances::grain_foresight);
  }
  bool wakes(size_t i, size_t j) {
    const double ri = grains.points[i].radius, rj = grains.points[j].radius;
    const GrainMover& m = grains.movers[i];
    const double slow = tolerances::grain_wakes * GrainField::rest_speed(tick(), ri);
    return m.v.norm() + ri * m.spin.norm() > slow &&
           distance(i, j) <= (ri + rj) * (1 + tolerances::grain_margin);
  }
  /// By its definition: who is awake after a search.
  std::vector<uint8_t> sleep_on() {
    std::vector<uint8_t> asleep = grains.asleep;
    for (size_t i = 0; i < grains.size(); ++i)
      for (size_t j = 0; j < grains.size(); ++j)
        if (!grains.asleep[i] && grains.asleep[j] && wakes(i, j)) asleep[j] = 0;
    return asleep;
  }
  GrainPairList all_pairs() const {
    GrainPairList out;
    out.first.push_back(0);
    for (uint32_t i = 0; i < grains.size(); ++i) {
      for (uint32_t n = grains.ordinal[i] + 1; n < grains.size(); ++n) {
        const uint32_t j = grains.place_of[n];
        if (!(grains.asleep[i] && grains.asleep[j]) && may_touch(i, j)) out.all.push_back({i, j});
      }
      out.first.push_back(uint32_t(out.all.size()));
    }
    return out;
  }
};

}  // namespace

TEST_CASE("pairs of grains and who wakes are what every two of them say, on every machine") {
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    for (const int threads : {1, 3}) {
      CAPTURE(hwy::TargetName(target));
      CAPTURE(threads);
      Cloud cloud(threads);
      GrainPairs finder;
      GrainPairList found;
      for (int k = 0; k < 2; ++k) {
        const std::vector<uint8_t> asleep = cloud.sleep_on();
        const auto sleepers = size_t(std::ranges::count(asleep, 1));
        CHECK(sleepers > 100);
        if (k == 0) CHECK(sleepers < cloud.grains.sleepers);
        REQUIRE(finder.find(cloud.tick(), cloud.grains, part, found).ok());
        CHECK(cloud.grains.asleep == asleep);
        CHECK(cloud.grains.sleepers == sleepers);
        const GrainPairList all = cloud.all_pairs();
        CHECK(all.all.size() > 1000);
        CHECK(found.first == all.first);
        CHECK(std::ranges::equal(found.all, all.all, [](const GrainPair& u, const GrainPair& v) {
          return u.a == v.a && u.b == v.b;
        }));
        // Parts of a tick after the first one find grains elsewhere than along the curve.
        for (size_t i = 0; i < cloud.grains.size(); ++i)
          if (!cloud.grains.asleep[i])
            cloud.grains.points[i].x += 4 * part * cloud.grains.movers[i].v;
      }
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST_CASE("a grain too far away for cells to tell it from others is an error") {
  Cloud cloud(1);
  cloud.grains.points[7].x = Vec3(1e16, 0, 0);
  GrainPairs finder;
  GrainPairList found;
  const Status refused = finder.find(cloud.tick(), cloud.grains, part, found);
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.error().code == ErrorCode::numeric);
}
