// Reference: brute force over all pairs of bounds, written out here once more; for 10^5 bounds a
// sweep along x, itself checked against brute force. Pairs are decided exactly: no resolution
// error.
#include "engine/collision/broad_phase.hpp"

#include "engine/geometry/debug_draw.hpp"
#include "tests/collision/support.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>

using namespace tumble;
using namespace tumble::test;

namespace {

bool apart(const Aabb& a, const Aabb& b) {
  for (int k = 0; k < 3; ++k)
    if (a.max[k] < b.min[k] || b.max[k] < a.min[k] || a.min[k] > a.max[k] || b.min[k] > b.max[k])
      return true;
  return false;
}

std::vector<ProxyPair> reference(const std::vector<BroadPhaseProxy>& proxies) {
  std::vector<ProxyPair> pairs;
  for (uint32_t i = 0; i < proxies.size(); ++i)
    for (uint32_t j = i + 1; j < proxies.size(); ++j)
      if ((proxies[i].moving || proxies[j].moving) && !apart(proxies[i].bounds, proxies[j].bounds))
        pairs.push_back({i, j});
  return pairs;
}

std::vector<ProxyPair> sweep(const std::vector<BroadPhaseProxy>& proxies) {
  std::vector<uint32_t> order(proxies.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto left = [&](uint32_t i) { return proxies[i].bounds.min.x(); };
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return left(a) < left(b); });
  std::vector<ProxyPair> pairs;
  for (size_t a = 0; a < order.size(); ++a)
    for (size_t b = a + 1; b < order.size(); ++b) {
      const BroadPhaseProxy &p = proxies[order[a]], &q = proxies[order[b]];
      if (q.bounds.min.x() > p.bounds.max.x()) break;
      if ((p.moving || q.moving) && !apart(p.bounds, q.bounds))
        pairs.push_back({std::min(order[a], order[b]), std::max(order[a], order[b])});
    }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

void check_pairs(BroadPhase& phase, const std::vector<BroadPhaseProxy>& proxies,
                 const std::vector<ProxyPair>& expected) {
  std::vector<ProxyPair> pairs{{7, 9}};
  phase.find_pairs(proxies, pairs);
  const bool equal = pairs == expected;
  CHECK(equal);
  CHECK(phase.stats().found == expected.size());
}

/// One of each broad phase, kept from world to world as the stepper keeps it from tick to tick.
struct AllPhases {
  std::vector<std::unique_ptr<BroadPhase>> phases;

  AllPhases() {
    for (const BroadPhaseEntry& entry : all_broad_phases()) phases.push_back(entry.make());
  }
  void check(const std::vector<BroadPhaseProxy>& proxies, const std::vector<ProxyPair>& expected) {
    for (size_t k = 0; k < phases.size(); ++k) {
      CAPTURE(all_broad_phases()[k].name);
      check_pairs(*phases[k], proxies, expected);
    }
  }
};

void check_all(const std::vector<BroadPhaseProxy>& proxies) {
  const auto expected = reference(proxies);
  AllPhases all;
  // Nothing is left over from the calls before, be their world the same, mirrored or cut short.
  all.check(proxies, expected);
  all.check(proxies, expected);
  const std::vector<BroadPhaseProxy> reversed(proxies.rbegin(), proxies.rend());
  all.check(reversed, reference(reversed));
  const std::vector<BroadPhaseProxy> half(proxies.begin(),
                                          proxies.begin() + std::ptrdiff_t(proxies.size() / 2));
  all.check(half, reference(half));
  all.check(proxies, expected);
}

/// Does it with one of each broad phase that is to be faster than brute force.
void with_each_fast_phase(const std::function<void(BroadPhase&)>& work) {
  for (const BroadPhaseEntry& entry : all_broad_phases()) {
    if (entry.name == "brute_force") continue;
    CAPTURE(entry.name);
    work(*entry.make());
  }
}

/// Every phase but brute force finds the pairs, with comparisons in proportion to the bounds.
void check_few_tests(const std::vector<BroadPhaseProxy>& proxies,
                     const std::vector<ProxyPair>& expected, uint64_t each = 60) {
  with_each_fast_phase([&](BroadPhase& phase) {
    check_pairs(phase, proxies, expected);
    CHECK(phase.stats().tested < each * proxies.size());
  });
}

BroadPhaseProxy cube(const Vec3& centre, double half, bool moving = true) {
  return {{centre.array() - half, centre.array() + half}, moving};
}

double log_uniform(Random& r, double ratio) {
  return det::exp(r.uniform(0, det::log(ratio)));
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

TEST_CASE("pairs of one owner are left out, also where little moves") {
  Random r(15);
  size_t left_out = 0;
  for (int w = 0; w < cases(40); ++w) {
    // The second half of the worlds is what grids leave to trees: many that rest, few that move.
    const bool few = w % 2 == 1;
    const uint64_t n = few ? 300 : 50 + r.below(100);
    Vec3 centre = Vec3::Zero();
    std::vector<BroadPhaseProxy> proxies;
    std::vector<uint32_t> owners;
    ProxyNews news;
    for (uint32_t i = 0; i < n; ++i) {
      const bool next = r.below(4) == 0;
      if (next) centre = random_vec(r, -4, 4);
      const Vec3 c = centre + random_vec(r, -0.4, 0.4), h = random_vec(r, 0.1, 0.8);
      proxies.push_back({{c - h, c + h}, few ? i % 16 == 0 : r.below(3) != 0});
      owners.push_back(owners.empty() ? 0 : owners.back() + uint32_t(next));
    }
    news.everything(proxies);
    std::vector<ProxyPair> expected = reference(proxies);
    const size_t of_all = expected.size();
    std::erase_if(expected, [&](const ProxyPair& p) { return owners[p.a] == owners[p.b]; });
    left_out += of_all - expected.size();
    AllPhases all;
    for (const auto& phase : all.phases) {
      phase->set_owners(owners);
      check_pairs(*phase, proxies, expected);
      std::vector<ProxyPair> pairs;
      for (int tick = 0; tick < 3; ++tick) {
        phase->find_pairs(proxies, news, pairs);
        CHECK(pairs == expected);
        ++news.number;
        news.all = false;
      }
      news.everything(proxies);
      phase->set_owners({});
      phase->find_pairs(proxies, news, pairs);
      CHECK(pairs.size() == of_all);
    }
  }
  CHECK(left_out > 0);
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
  check_few_tests(proxies, reference(proxies), 20);
}

TEST_CASE("sizes from 1 to 10^4, fast movers, clusters, empty space, 10 km from the origin") {
  Random r(13);
  const int worlds = cases(60);
  uint64_t pairs = 0, bodies = 0;
  for (int w = 0; w < worlds; ++w) {
    std::vector<BroadPhaseProxy> proxies;
    const auto n = 50 + r.below(400);
    const Vec3 far = w % 3 == 0 ? Vec3(1e4, -1e4, 1e4) : Vec3::Zero();
    // Sizes that meet about as often as equal ones: large bodies decide the room.
    const double room = 1.2e4 * std::cbrt(double(n) / 20);
    for (uint64_t i = 0; i < n; ++i) {
      Vec3 c = far + random_vec(r, -room, room) / 2;
      double half = 0.5 * log_uniform(r, 1e4);
      if (w % 5 == 1) {  // a pile of small ones, and a few stray ones across empty space
        half = 0.2;
        c = i % 50 == 0 ? random_vec(r, -1e6, 1e6) : Vec3(far + random_vec(r, 0, 4));
      }
      if (w % 5 == 2) c = far + random_vec(r, 0, 1e-3);  // all at one place
      if (w % 5 == 3 && i % 4) half = 0;                 // points among boxes
      BroadPhaseProxy p = cube(c, half, r.below(4) != 0);
      if (w % 5 == 4 && i % 3 == 0)  // swept over a long way
        p.bounds.include(Vec3(c + 3000 * random_direction(r)));
      proxies.push_back(p);
    }
    if (w % 2) proxies.push_back({{Vec3(-1e3, -1, -1e3), Vec3(1e3, 0, 1e3)}, false});
    bodies += proxies.size();
    pairs += reference(proxies).size();
    check_all(proxies);
  }
  if (worlds >= 50) CHECK(pairs > bodies);
}

TEST_CASE("boxes that touch exactly are pairs, and those one rounding apart are not") {
  for (const double at : {0.0, 1.0, 1e4, -1e4, 1e8}) {
    std::vector<BroadPhaseProxy> p;
    for (int x = 0; x < 6; ++x)
      for (int y = 0; y < 6; ++y)
        for (int z = 0; z < 6; ++z) p.push_back(cube(Vec3(at + x, at + y, at + z), 0.5));
    check_all(p);
    CHECK(reference(p).size() > p.size() * 8);  // 26 neighbours in the middle
    for (BroadPhaseProxy& q : p)
      for (int k = 0; k < 3; ++k) q.bounds.max[k] = std::nextafter(q.bounds.max[k], -1e300);
    check_all(p);
    CHECK(reference(p).empty());
  }
}

TEST_CASE("bounds that are all infinite, all empty, half empty, and as large as doubles go") {
  const double inf = std::numeric_limits<double>::infinity();
  const double max = std::numeric_limits<double>::max();
  std::vector<BroadPhaseProxy> p(20, {{Vec3::Constant(-inf), Vec3::Constant(inf)}, true});
  check_all(p);
  check_all(std::vector<BroadPhaseProxy>(20, {Aabb{}, true}));
  for (int i = 0; i < 20; ++i) p.push_back(cube(Vec3(i, 0, 0), 1));
  p.push_back({{Vec3(0, 0, 1), Vec3(9, 9, 0)}, true});  // empty along z only
  p.push_back({{Vec3::Constant(-max), Vec3::Constant(max)}, true});
  p.push_back({{Vec3::Constant(max / 2), Vec3::Constant(max)}, true});
  p.push_back({{Vec3::Constant(-max), Vec3::Constant(-max)}, true});
  p.push_back({{Vec3(0, 0, 0), Vec3(0, 0, 1e-300)}, true});
  p.push_back({{Vec3(-inf, 0, 0), Vec3(0, 0, 0)}, false});
  p.push_back({{Vec3(inf, 0, 0), Vec3(inf, 1, 1)}, true});  // a wall at infinity
  check_all(p);
}

TEST_CASE("pairs stay right over steps in which bodies move, fall asleep, wake, come and go") {
  Random r(14);
  AllPhases all;
  std::vector<BroadPhaseProxy> proxies{{{Vec3(-40, -1, -40), Vec3(40, 0, 40)}, false}};
  const int steps = cases(400);
  uint64_t asleep = 0, bodies = 0, found = 0, made = 0, removed = 0;
  for (int step = 0; step < steps; ++step) {
    for (size_t i = 1; i < proxies.size(); ++i) {
      BroadPhaseProxy& p = proxies[i];
      if (r.below(40) == 0) p.moving = !p.moving;
      // Now and then a resting one is put elsewhere without being awake.
      if (!p.moving && r.below(200) != 0) continue;
      const Vec3 d = random_vec(r, -0.2, 0.2);
      p.bounds = {p.bounds.min + d, p.bounds.max + d};
    }
    // Anywhere in the list: what follows is renumbered.
    const auto place = [&] {
      return proxies.begin() + 1 + std::ptrdiff_t(r.below(uint32_t(proxies.size())));
    };
    for (int k = step < 20 ? 15 : int(r.below(3)); k-- > 0; ++made) {
      const auto at = place();
      proxies.insert(at, cube(random_vec(r, 0, 9), 0.3 * log_uniform(r, 4), r.below(2)));
    }
    if (step % 7 == 0 && proxies.size() > 100) {
      // Two copies of one box at different places, of which one then goes.
      proxies.insert(place(), proxies[5]);
      proxies.erase(proxies.begin() + std::ptrdiff_t(1 + r.below(uint32_t(proxies.size()) - 1)));
      ++removed;
    }
    if (step == 200) proxies.erase(proxies.begin() + 10, proxies.begin() + 200);
    const auto expected = reference(proxies);
    all.check(proxies, expected);
    found += expected.size();
    bodies += proxies.size();
    for (const BroadPhaseProxy& p : proxies) asleep += !p.moving;
  }
  if (steps < 300) return;
  CHECK((asleep > bodies * 3 / 10 && asleep < bodies * 7 / 10));
  CHECK(found > bodies / 2);
  CHECK((made > 300 && removed > 50));
}

TEST_CASE("10^5 bounds, one cluster among them") {
  Random r(15);
  for (const double ratio : {1.0, 1e4}) {
    std::vector<BroadPhaseProxy> proxies;
    const int n = std::max(cases(100'000), 4000);
    const double side = 2 * std::cbrt(double(n) / 3) * (ratio > 1 ? 3000 : 1);
    for (int i = 0; i < n; ++i) {
      Vec3 c = random_vec(r, 0, side);
      if (i % 100 == 0) c = random_vec(r, 0, side / 20);
      proxies.push_back(cube(c, 0.5 * log_uniform(r, ratio), i % 10 != 0));
    }
    if (n <= 4000) CHECK(sweep(proxies) == reference(proxies));
    const auto expected = sweep(proxies);
    CHECK((expected.size() > size_t(n) / 2 && expected.size() < size_t(n) * 20));
    check_few_tests(proxies, expected);
  }
}

TEST_CASE("as many large bounds as small ones cost no quadratic time") {
  Random r(19);
  const int n = std::max(cases(5000), 500);
  const double side = 20 * std::cbrt(double(n));
  std::vector<BroadPhaseProxy> proxies;
  for (int i = 0; i < 2 * n; ++i)
    proxies.push_back(cube(random_vec(r, 0, side), i % 2 ? 0.5 : 5, i % 3 != 0));
  const auto expected = sweep(proxies);
  CHECK(expected.size() > size_t(n) / 4);
  check_few_tests(proxies, expected);
}

TEST_CASE("any number of threads finds the same pairs with as many comparisons") {
  Random r(20);
  for (const double ratio : {1.0, 30.0}) {
    std::vector<BroadPhaseProxy> proxies;
    for (int i = 0; i < 6000; ++i)
      proxies.push_back(
          cube(random_vec(r, 0, 18 * ratio), 0.5 * log_uniform(r, ratio), i % 5 != 0));
    // The second world is seen from far: clusters within one cell of its curve.
    if (ratio > 1) {
      proxies.push_back(cube(Vec3::Constant(1e8), 1));
      proxies.push_back(cube(Vec3::Constant(-1e8), 1));
    }
    const auto expected = sweep(proxies);
    CHECK(expected.size() > 500);
    with_each_fast_phase([&](BroadPhase& phase) {
      check_pairs(phase, proxies, expected);
      const uint64_t tested = phase.stats().tested;
      for (const int threads : {1, 2}) {
        Crew crew(threads);
        phase.use_threads(&crew);
        check_pairs(phase, proxies, expected);
        CHECK(phase.stats().tested == tested);
        phase.use_threads(nullptr);
      }
    });
  }
}

TEST_CASE("a cluster seen from far is told apart, whatever the size of the world") {
  // Two bodies 10^6 m away stretch the world; a pile of small ones near the origin, which it would
  // cost 10^8 comparisons to take for one cell.
  Random r(16);
  std::vector<BroadPhaseProxy> proxies{cube(Vec3::Constant(1e6), 1), cube(Vec3::Constant(-1e6), 1)};
  for (int i = 0; i < 4000; ++i) proxies.push_back(cube(random_vec(r, 0, 10), 0.1));
  const auto expected = reference(proxies);
  check_few_tests(proxies, expected);
}

TEST_CASE("sleeping bounds cost the tree no comparisons") {
  Random r(17);
  std::vector<BroadPhaseProxy> proxies;
  for (int i = 0; i < 5000; ++i) proxies.push_back(cube(random_vec(r, 0, 17), 0.5, i == 0));
  const auto& list = all_broad_phases();
  const auto tree = std::find_if(list.begin(), list.end(), [](const auto& e) {
                      return e.name == "aabb_tree";
                    })->make();
  std::vector<ProxyPair> pairs;
  for (int step = 0; step < 5; ++step) {
    proxies[0] = cube(random_vec(r, 0, 17), 0.5);
    tree->find_pairs(proxies, pairs);
    CHECK(pairs == reference(proxies));
    CHECK(tree->stats().tested < 200);
  }
}

namespace {

struct DrawnBoxes final : DebugDraw {
  void line(const Vec3& a, const Vec3& b, const Vec4f&) override {
    ++lines;
    all.include(a);
    all.include(b);
  }
  void point(const Vec3&, const Vec4f&, float) override { FAIL("no points"); }
  void text(const Vec3&, const Vec4f&, std::string_view) override { FAIL("no text"); }
  int lines = 0;
  Aabb all;
};

}  // namespace

TEST_CASE("cells and boxes are drawn about what they hold, and brute force draws nothing") {
  Random r(18);
  std::vector<BroadPhaseProxy> proxies;
  Aabb all;
  for (int i = 0; i < 300; ++i) {
    proxies.push_back(cube(random_vec(r, -9, 9), i % 3 ? 0.5 : 0.25, i % 2));
    all.include(proxies.back().bounds);
  }
  proxies.push_back({{Vec3::Constant(-1e300), Vec3(1e300, 0, 1e300)}, false});
  proxies.push_back({Aabb{}, true});
  for (const BroadPhaseEntry& entry : all_broad_phases()) {
    CAPTURE(entry.name);
    std::vector<ProxyPair> pairs;
    const auto phase = entry.make();
    DrawnBoxes drawn;
    phase->draw({}, drawn);  // before the first pairs
    CHECK(drawn.lines == 0);
    phase->find_pairs(proxies, pairs);
    phase->draw(proxies, drawn);
    if (entry.name == "brute_force") {
      CHECK(drawn.lines == 0);
      continue;
    }
    CHECK((drawn.lines > 0 && drawn.lines % 12 == 0));
    // To single precision, and at most a cell of 1 m more.
    const double close = 1e-5;
    CHECK((drawn.all.min.array() <= all.min.array() + close).all());
    CHECK((drawn.all.max.array() >= all.max.array() - close).all());
    CHECK((drawn.all.min.array() >= all.min.array() - 1 - close).all());
    CHECK((drawn.all.max.array() <= all.max.array() + 1 + close).all());
  }
}
