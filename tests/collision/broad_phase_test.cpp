// Reference: brute force over all pairs of bounds, written out here once more.
#include "engine/collision/broad_phase.hpp"

#include "tests/collision/support.hpp"

#include <limits>

using namespace tumble;
using namespace tumble::test;

namespace {

std::vector<ProxyPair> reference(const std::vector<BroadPhaseProxy>& proxies) {
  std::vector<ProxyPair> pairs;
  for (uint32_t i = 0; i < proxies.size(); ++i)
    for (uint32_t j = i + 1; j < proxies.size(); ++j) {
      if (!proxies[i].moving && !proxies[j].moving) continue;
      const Aabb &a = proxies[i].bounds, &b = proxies[j].bounds;
      bool apart = false;
      for (int k = 0; k < 3; ++k) apart = apart || a.max[k] < b.min[k] || b.max[k] < a.min[k];
      if (!apart) pairs.push_back({i, j});
    }
  return pairs;
}

void check_all(const std::vector<BroadPhaseProxy>& proxies) {
  const auto expected = reference(proxies);
  for (const BroadPhaseEntry& entry : all_broad_phases()) {
    CAPTURE(entry.name);
    std::vector<ProxyPair> pairs{{7, 9}};
    const auto phase = entry.make();
    phase->find_pairs(proxies, pairs);
    CHECK(pairs == expected);
    CHECK(phase->stats().found == expected.size());
    phase->find_pairs(proxies, pairs);  // nothing is left over from the first call
    CHECK(pairs == expected);
  }
}

}  // namespace

TEST_CASE("every broad phase finds the pairs of random worlds") {
  Random r(11);
  const int worlds = cases(200);
  uint64_t pairs = 0, bodies = 0;
  for (int w = 0; w < worlds; ++w) {
    std::vector<BroadPhaseProxy> proxies;
    const int n = int(r.below(120));
    const double spread = r.uniform(1, 12), ratio = w % 4 == 0 ? 4 : 1;
    for (int i = 0; i < n; ++i) {
      const Vec3 c = random_vec(r, -spread, spread);
      Vec3 h = random_vec(r, 0.1, 0.8);
      if (r.below(10) == 0) h *= det::exp(r.uniform(0, ratio));
      proxies.push_back({{c - h, c + h}, r.below(3) != 0});
    }
    bodies += proxies.size();
    pairs += reference(proxies).size();
    check_all(proxies);
  }
  if (worlds >= 50) CHECK((pairs > bodies / 4 && pairs < bodies * 40));
}

TEST_CASE("infinite, touching, empty, tiny and far bounds") {
  const double inf = std::numeric_limits<double>::infinity();
  std::vector<BroadPhaseProxy> p;
  p.push_back({{Vec3::Constant(-inf), Vec3(inf, 0, inf)}, false});  // a half-space
  p.push_back({{Vec3(0, 0, 0), Vec3(1, 1, 1)}, true});              // touches it and the next
  p.push_back({{Vec3(1, 0, 0), Vec3(2, 1, 1)}, true});
  p.push_back({Aabb{}, true});  // empty
  p.push_back({{Vec3(1e9, 1e9, 1e9), Vec3(1e9 + 1, 1e9 + 1, 1e9 + 1)}, true});
  p.push_back({{Vec3(1e9, 1e9, 1e9), Vec3(1e9, 1e9, 1e9)}, true});  // a point
  p.push_back({{Vec3(-1e12, -1, -1), Vec3(1e12, 1, 1)}, true});
  p.push_back({{Vec3(0.5, 0.5, 0.5), Vec3(0.5, 0.5, 0.5)}, false});
  check_all(p);
  check_all({});
}

TEST_CASE("the grid compares far fewer bounds than brute force in a large world") {
  Random r(12);
  std::vector<BroadPhaseProxy> proxies;
  for (int i = 0; i < 4000; ++i) {
    const Vec3 c = random_vec(r, -20, 20), h = random_vec(r, 0.25, 0.75);
    proxies.push_back({{c - h, c + h}, true});
  }
  proxies.push_back({{Vec3(-50, -50, -50), Vec3(50, 0, 50)}, false});
  for (const BroadPhaseEntry& entry : all_broad_phases()) {
    if (entry.name == "brute_force") continue;
    std::vector<ProxyPair> pairs;
    const auto phase = entry.make();
    phase->find_pairs(proxies, pairs);
    CHECK(pairs == reference(proxies));
    CHECK(phase->stats().tested < 20 * proxies.size());
  }
}
