// Pairs of bodies in groups. Reference: all overlapping bounds, without those of one group.
#include "engine/dynamics/bodies/proxies.hpp"
#include "tests/dynamics/piles.hpp"
#include "tests/dynamics/rigid_world.hpp"

#include <algorithm>
#include <limits>

using namespace tumble;
using namespace tumble::test;

TEST_CASE("the broad phase collects no pairs of one group, whatever the group's number") {
  constexpr uint32_t most = std::numeric_limits<uint32_t>::max();
  Random random(7);
  std::vector<RigidBody> bodies;
  for (uint32_t i = 0; i < 120; ++i) {
    BodyDef def = body(box(0.3, 0.2, 0.1), Vec3::Zero());
    if (i % 4 == 0) def.shapes.push_back(def.shapes[0]);
    // The last of these numbers are those of slots, counted from the end.
    const uint32_t groups[] = {0, 1, 2, most, most - 5};
    def.group = groups[i % 5];
    RigidBody made = *make_body(def);
    made.group = def.group;
    made.pose.x = {random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5), random.uniform(-1, 1)};
    bodies.push_back(std::move(made));
  }
  ProxySet set;
  update_proxies(bodies, Vec3::Zero(), 1.0 / 60, 0.01, set);
  std::vector<ProxyPair> expected;
  size_t within = 0;
  for (uint32_t a = 0; a < set.proxies.size(); ++a)
    for (uint32_t b = a + 1; b < set.proxies.size(); ++b) {
      const uint32_t of_a = set.refs[a].body, of_b = set.refs[b].body;
      if (of_a == of_b || !set.proxies[a].bounds.overlaps(set.proxies[b].bounds)) continue;
      const bool together = bodies[of_a].group != 0 && bodies[of_a].group == bodies[of_b].group;
      within += together;
      if (!together) expected.push_back({a, b});
    }
  CHECK(within > expected.size() / 10);
  PairFilter filter;
  filter.set_groups(bodies);
  for (const BroadPhaseEntry& entry : all_broad_phases()) {
    CAPTURE(entry.name);
    const auto phase = entry.make();
    phase->set_owners(set.owners);
    std::vector<ProxyPair> pairs;
    phase->find_pairs(set.proxies, set.news, pairs);
    // What is left to the filter is of the two groups with numbers of slots.
    for (const ProxyPair& p : pairs) {
      const uint32_t group = bodies[set.refs[p.a].body].group;
      if (group == bodies[set.refs[p.b].body].group) CHECK((group == 0 || group >= most - 5));
    }
    filter.apply(set, pairs);
    CHECK(pairs.size() == expected.size());
    CHECK(std::ranges::equal(pairs, expected, [](const ProxyPair& p, const ProxyPair& q) {
      return p.a == q.a && p.b == q.b;
    }));
  }
}
