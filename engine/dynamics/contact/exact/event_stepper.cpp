#include "engine/dynamics/contact/exact/event_stepper.hpp"

#include "engine/core/parallel.hpp"
#include "engine/core/registry.hpp"

#include <algorithm>
#include <numeric>

namespace tumble {
namespace {

uint32_t root_of(std::vector<uint32_t>& parent, uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

}  // namespace

void EventStepper::build_groups(std::span<const RigidBody> bodies, const ProxySet& proxies,
                                std::span<const ProxyPair> pairs, std::span<const BodyLink> links) {
  const auto moves = [&](uint32_t slot) { return bodies[slot].type != BodyType::fixed; };
  std::vector<uint32_t> parent(bodies.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto join = [&](uint32_t a, uint32_t b) {
    if (!moves(a) || !moves(b)) return;
    const uint32_t ra = root_of(parent, a), rb = root_of(parent, b);
    parent[std::max(ra, rb)] = std::min(ra, rb);  // the least slot stands for the group
  };
  for (const ProxyPair& p : pairs) join(proxies.refs[p.a].body, proxies.refs[p.b].body);
  for (const BodyLink& l : links) join(l.a, l.b);

  groups_.clear();
  group_of_.assign(bodies.size(), no_block);
  block_of_.assign(bodies.size(), no_block);
  for (uint32_t slot = 0; slot < bodies.size(); ++slot) {
    if (!moves(slot)) continue;
    const uint32_t root = root_of(parent, slot);
    if (root == slot) {
      group_of_[slot] = uint32_t(groups_.size());
      groups_.emplace_back();
    }
    BodyGroup& group = groups_[group_of_[slot] = group_of_[root]];
    block_of_[slot] = uint32_t(group.bodies.size());
    group.bodies.push_back(slot);
  }
  const auto group_of = [&](uint32_t a, uint32_t b) {
    return group_of_[a] != no_block ? group_of_[a] : group_of_[b];
  };
  for (const ProxyPair& p : pairs) {
    ShapeRef a = proxies.refs[p.a], b = proxies.refs[p.b];
    if (a.body == b.body || (!bodies[a.body].dynamic() && !bodies[b.body].dynamic())) continue;
    if (b.body < a.body) std::swap(a, b);
    groups_[group_of(a.body, b.body)].pairs.push_back({a, b, 0});
  }
  for (BodyGroup& g : groups_)
    std::sort(g.pairs.begin(), g.pairs.end(), [](const EventPair& p, const EventPair& q) {
      return std::tie(p.a.body, p.b.body, p.a.shape, p.b.shape) <
             std::tie(q.a.body, q.b.body, q.a.shape, q.b.shape);
    });
  for (EventContact& c : contacts) {
    const uint32_t group = group_of(c.key.body_a, c.key.body_b);
    if (group != no_block) groups_[group].contacts.push_back(c);
  }
}

Status EventStepper::step(std::span<RigidBody> bodies, const ProxySet& proxies,
                          std::span<const ProxyPair> pairs, std::span<const BodyLink> links,
                          const SmoothForces& forces, EventContext context, double h,
                          tbb::task_arena& arena) {
  const auto law = find_named(all_impact_laws(), context.settings.impulses, "law of impulses");
  if (!law) return law.error();
  context.law = (*law)->resolve;
  build_groups(bodies, proxies, pairs, links);
  std::vector<EventStats> counted(groups_.size());
  std::vector<Status> done(groups_.size());
  parallel_for(arena, groups_.size(), [&](size_t i) {
    done[i] = EventGroup(bodies, groups_[i], block_of_, forces, context).advance(h, counted[i]);
  });
  stats = {};
  contacts.clear();
  for (size_t i = 0; i < groups_.size(); ++i) {
    if (!done[i]) return done[i];
    stats.include(counted[i]);
    contacts.insert(contacts.end(), groups_[i].contacts.begin(), groups_[i].contacts.end());
  }
  return {};
}

}  // namespace tumble
