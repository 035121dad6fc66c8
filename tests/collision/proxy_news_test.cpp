// Lists of proxies that say what changed since the call before. Reference: brute force over all
// pairs of bounds, decided exactly.
#include "engine/collision/broad_phase.hpp"
#include "tests/collision/support.hpp"

#include <algorithm>
#include <limits>

using namespace tumble;
using namespace tumble::test;

namespace {

std::vector<ProxyPair> reference(const std::vector<BroadPhaseProxy>& proxies) {
  std::vector<ProxyPair> pairs;
  for (uint32_t i = 0; i < proxies.size(); ++i)
    for (uint32_t j = i + 1; j < proxies.size(); ++j) {
      const Aabb &a = proxies[i].bounds, &b = proxies[j].bounds;
      if ((proxies[i].moving || proxies[j].moving) && !a.empty() && !b.empty() &&
          (a.min.array() <= b.max.array()).all() && (b.min.array() <= a.max.array()).all())
        pairs.push_back({i, j});
    }
  return pairs;
}

/// A list of proxies and what it says of itself; what moves is drawn anew in every update.
struct MovingList {
  Random r;
  std::vector<BroadPhaseProxy> proxies;
  ProxyNews news;
  double room = 0;

  explicit MovingList(uint64_t seed) : r(seed) { refill(); }

  Aabb any_bounds() {
    const double inf = std::numeric_limits<double>::infinity();
    const uint32_t kind = r.below(60);
    if (kind == 0) return {};
    if (kind == 1) return {Vec3::Constant(-inf), Vec3(inf, r.uniform(-room, room), inf)};
    const Vec3 c = random_vec(r, -room, room);
    Vec3 h = random_vec(r, 0, 0.6);
    if (kind == 2) h *= 1e12;
    if (kind == 3) h *= 20;
    return {c - h, c + h};
  }
  /// Another count; everything may have changed.
  void refill() {
    const size_t kept = r.below(2) ? r.below(uint32_t(proxies.size()) + 1) : 0;
    proxies.resize(kept);
    const size_t count = 1 + r.below(700);
    room = 0.7 * std::cbrt(double(count));
    const uint32_t one_in = r.below(3) ? 20 : 3;
    while (proxies.size() < count) proxies.push_back({any_bounds(), r.below(one_in) == 0});
    news.everything(proxies);
  }
  /// Some of what moves settles, some of what rests starts to move.
  void update() {
    const uint32_t settles = 2 + r.below(6), starts = r.below(10) == 0 ? 3 : 60;
    ++news.number;
    news.all = false;
    news.moving.clear();
    news.settled.clear();
    for (uint32_t i = 0; i < proxies.size(); ++i) {
      const bool moved = proxies[i].moving;
      proxies[i].moving = moved ? r.below(settles) > 0 : r.below(starts) == 0;
      if (!moved && !proxies[i].moving) continue;
      if (r.below(4) > 0) proxies[i].bounds = any_bounds();
      (proxies[i].moving ? news.moving : news.settled).push_back(i);
    }
  }
  bool few() const { return proxies.size() >= 256 && news.moving.size() < proxies.size() / 4; }
};

}  // namespace

TEST_CASE("every broad phase finds the pairs of lists that say what changed") {
  const int lists = cases(40);
  int few = 0, many = 0, turns = 0;
  uint64_t found = 0;
  for (int k = 0; k < lists; ++k) {
    MovingList list(uint64_t(100 + k));
    std::vector<std::unique_ptr<BroadPhase>> phases;
    for (const BroadPhaseEntry& entry : all_broad_phases()) phases.push_back(entry.make());
    bool was_few = false;
    for (int call = 0; call < 50; ++call) {
      if (call > 0) list.r.below(12) == 0 ? list.refill() : list.update();
      const bool skips = list.r.below(15) == 0;    // an update that nobody asks for
      const bool forgets = list.r.below(15) == 0;  // a call in between without news
      if (skips) continue;
      const auto expected = reference(list.proxies);
      found += expected.size();
      for (size_t p = 0; p < phases.size(); ++p) {
        CAPTURE(all_broad_phases()[p].name);
        std::vector<ProxyPair> pairs{{7, 9}};
        if (forgets) phases[p]->find_pairs(list.proxies, pairs);
        phases[p]->find_pairs(list.proxies, list.news, pairs);
        const bool equal = pairs == expected;
        REQUIRE(equal);
        CHECK(phases[p]->stats().found == expected.size());
      }
      ++(list.few() ? few : many);
      turns += was_few != list.few();
      was_few = list.few();
    }
  }
  CHECK(found > uint64_t(lists) * 50);
  if (lists >= 20) CHECK((few > lists * 5 && many > lists * 5 && turns > lists));
}
