#include "engine/dynamics/event/watched_pair.hpp"

#include <algorithm>
#include <tuple>

namespace tumble {
namespace {

auto shapes_of(const EventPair& p) {
  return std::tie(p.a.body, p.b.body, p.a.shape, p.b.shape);
}
auto shapes_of(const EventContact& c) {
  return std::tie(c.key.body_a, c.key.body_b, c.key.shape_a, c.key.shape_b);
}

}  // namespace

bool WatchedPair::closed() const {
  return std::any_of(contacts.begin(), contacts.end(),
                     [](const EventContact& c) { return c.closed; });
}

void WatchedPair::look(std::span<const RigidBody> bodies, const HierarchyKind* hierarchy,
                       double limit, double gone_now) {
  const RigidBody &p = bodies[pair.a.body], &q = bodies[pair.b.body];
  max_displacement = gone_now;
  measured = false;
  gap = (p.pose.x - q.pose.x).norm() - p.bounding_radius - q.bounding_radius;
  if (gap > limit) return;
  const PairGap g = gap_of_pair(pair, bodies, limit, hierarchy);
  measured = g.near;
  gap = g.near ? g.gap : limit;
}

void WatchedPair::take(const EventPair& p, std::span<const EventContact> all, double gone_now) {
  pair = p;
  const auto mine = all.subspan(p.first_contact, p.contacts);
  contacts.assign(mine.begin(), mine.end());
  measured = p.gap.near;
  gap = p.gap.gap;
  max_displacement = gone_now;
}

std::vector<WatchedPair> watched_pairs(BodyGroup& group, std::span<const uint32_t> block_of) {
  std::stable_sort(group.contacts.begin(), group.contacts.end(),
                   [](const auto& c, const auto& d) { return shapes_of(c) < shapes_of(d); });
  std::vector<WatchedPair> out;
  out.reserve(group.pairs.size());
  auto c = group.contacts.begin();
  for (const EventPair& p : group.pairs) {
    WatchedPair& w = out.emplace_back();
    w.pair = p;
    w.a = block_of[p.a.body], w.b = block_of[p.b.body];
    while (c != group.contacts.end() && shapes_of(*c) < shapes_of(p)) ++c;
    for (; c != group.contacts.end() && shapes_of(*c) == shapes_of(p); ++c)
      w.contacts.push_back(*c);
  }
  return out;
}

void give_back(std::span<const WatchedPair> pairs, std::span<const double> max_displacement,
               BodyGroup& group) {
  const auto gone_by = [&](uint32_t place) {
    return place == no_block ? 0 : max_displacement[place];
  };
  group.contacts.clear();
  for (size_t k = 0; k < pairs.size(); ++k) {
    const WatchedPair& w = pairs[k];
    EventPair& p = group.pairs[k] = w.pair;
    p.first_contact = group.contacts.size();
    p.contacts = w.meets ? w.contacts.size() : 0;
    if (w.meets) {
      group.contacts.insert(group.contacts.end(), w.contacts.begin(), w.contacts.end());
      continue;
    }
    p.gap.near = false;
    p.gap.gap = w.least_gap(gone_by(w.a) + gone_by(w.b));
  }
}

}  // namespace tumble
