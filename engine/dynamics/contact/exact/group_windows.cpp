#include "engine/dynamics/contact/exact/group_windows.hpp"

#include <algorithm>
#include <limits>

namespace tumble {
namespace {

constexpr uint32_t whole = 4096;  ///< a tick, in units of its shortest window
constexpr int most_redone = 40;   ///< times that a window is gone through again
/// Steps that may be spent on bodies that move with strangers, for each of all bodies in a window.
constexpr size_t most_spent = 4;
constexpr size_t few = 4;          ///< strangers
constexpr double least_ahead = 4;  ///< a gap is measured as far as so many reaches
constexpr double between = 1e-6;   ///< what projections may move bodies between windows [m]
constexpr double last_digits = 1e-9;

auto shapes_of(const EventPair& p) {
  return std::tie(p.a.body, p.b.body, p.a.shape, p.b.shape);
}
auto shapes_of(const EventContact& c) {
  return std::tie(c.key.body_a, c.key.body_b, c.key.shape_a, c.key.shape_b);
}

uint32_t place_of(const BodyGroup& group, uint32_t slot) {
  const auto at = std::lower_bound(group.bodies.begin(), group.bodies.end(), slot);
  if (at == group.bodies.end() || *at != slot) return no_block;
  return uint32_t(at - group.bodies.begin());
}

}  // namespace

bool GroupWindows::scattered(const BodyGroup& group, const EventContext& context) {
  if (group.bodies.size() <= context.most_strangers + 1) return false;
  BodyClusters tied;
  tied.reset(group.bodies.size());
  const auto place = [&](uint32_t slot) { return place_of(group, slot); };
  for (const auto& [a, b] : group.ties) tied.tie(place(a), place(b));
  for (const EventContact& c : group.contacts) {
    const uint32_t a = place(c.key.body_a), b = place(c.key.body_b);
    if (c.closed && a != no_block && b != no_block) tied.tie(a, b);
  }
  for (uint32_t i = 1; i < group.bodies.size(); ++i) tied.meet(0, i);
  return tied.strangers() > context.most_strangers;
}

GroupWindows::GroupWindows(std::span<RigidBody> bodies, BodyGroup& group,
                           std::span<uint32_t> block_of, std::span<BodyReach> reaches,
                           const SmoothForces& forces, const EventContext& context)
    : bodies_(bodies),
      group_(group),
      block_of_(block_of),
      reaches_(reaches),
      forces_(forces),
      context_(context),
      gone_(group.bodies.size(), 0) {
  for (const uint32_t slot : group.bodies) halves_.push_back(box_about(bodies[slot]));
  for (const auto& [a, b] : group.ties) ties_.emplace_back(block_of[a], block_of[b]);
  size_t rows = 0;
  for (const uint32_t j : group.joints) {
    const Joint& joint = context.joints[j];
    const bool at_a = joint.a != no_body && block_of[joint.a] != no_block;
    joint_place_.push_back(block_of[at_a ? joint.a : joint.b]);
    joint_row_.push_back(rows);
    rows += row_count(joint.kind);
  }
  group.books.joint_impulses.resize(rows);
}

void GroupWindows::take_pairs() {
  std::stable_sort(group_.contacts.begin(), group_.contacts.end(),
                   [](const auto& c, const auto& d) { return shapes_of(c) < shapes_of(d); });
  auto c = group_.contacts.begin();
  for (const EventPair& p : group_.pairs) {
    Watched& w = pairs_.emplace_back();
    w.pair = p;
    w.a = block_of_[p.a.body], w.b = block_of_[p.b.body];
    w.gap = -std::numeric_limits<double>::infinity();
    while (c != group_.contacts.end() && shapes_of(*c) < shapes_of(p)) ++c;
    for (; c != group_.contacts.end() && shapes_of(*c) == shapes_of(p); ++c)
      w.contacts.push_back(*c);
    for (EventContact& known : w.contacts) {
      known.impacts = 0;
      known.impulse.setZero();
    }
  }
}

double GroupWindows::gone(const Watched& w) const {
  return (w.a == no_block ? 0 : gone_[w.a]) + (w.b == no_block ? 0 : gone_[w.b]);
}

void GroupWindows::look(Watched& w, double limit) const {
  const RigidBody &a = bodies_[w.pair.a.body], &b = bodies_[w.pair.b.body];
  w.gone = gone(w);
  w.measured = false;
  w.gap = (a.pose.x - b.pose.x).norm() - a.bounding_radius - b.bounding_radius;
  if (w.gap > limit) return;
  const PairGap g = gap_of_pair(w.pair, bodies_, limit, context_.hierarchy);
  w.measured = g.near;
  w.gap = g.near ? g.gap : limit;
}

bool GroupWindows::may_meet(Watched& w) {
  const double reach =
      reaches_[w.pair.a.body].distance + reaches_[w.pair.b.body].distance + between;
  const double moved = gone(w) - w.gone;
  if (w.gap - moved > reach) return false;
  if (!w.measured || moved > 0) look(w, looks_ahead_ * reach);
  return !(w.gap > reach);
}

bool GroupWindows::plan(uint32_t length, size_t most_strangers) {
  looks_ahead_ = std::max(least_ahead, whole / 64.0 / length);
  for (uint32_t i = 0; i < group_.bodies.size(); ++i) {
    const uint32_t slot = group_.bodies[i];
    reaches_[slot] = guess_reach(bodies_[slot], halves_[i], context_.gravity, time(length), h_);
  }
  return find_clusters(most_strangers);
}

bool GroupWindows::find_clusters(size_t most_strangers) {
  together_.reset(group_.bodies.size());
  for (const auto& [a, b] : ties_) together_.tie(a, b);
  const auto both_move = [](const Watched& w) { return w.a != no_block && w.b != no_block; };
  for (const Watched& w : pairs_)
    if (both_move(w) && std::any_of(w.contacts.begin(), w.contacts.end(),
                                    [](const EventContact& c) { return c.closed; }))
      together_.tie(w.a, w.b);
  for (Watched& w : pairs_) {
    w.meets = may_meet(w);
    if (w.meets && both_move(w)) together_.meet(w.a, w.b);
    if (together_.strangers() > most_strangers) return false;
  }
  return true;
}

bool GroupWindows::within_group(double left) {
  for (const uint32_t slot : group_.bodies) {
    const BodyReach& reach = group_.reaches[slot];
    const double needed = distance_gone(bodies_[slot], reach) + reaches_[slot].distance;
    if (needed > (1 + last_digits) * reach.distance)
      group_.strays.emplace_back(slot, wider_reach(bodies_[slot], reach, left));
  }
  return group_.strays.empty();
}

std::vector<BodyMotion> GroupWindows::motions() const {
  std::vector<BodyMotion> out;
  for (const uint32_t slot : group_.bodies) out.push_back(motion_of(bodies_[slot]));
  return out;
}

void GroupWindows::put_bodies(std::span<const BodyMotion> motions) {
  for (size_t i = 0; i < motions.size(); ++i) {
    RigidBody& b = bodies_[group_.bodies[i]];
    b.pose = motions[i].pose;
    b.v = motions[i].v;
    b.omega = motions[i].omega;
  }
}

void GroupWindows::make_clusters() {
  std::vector<Cluster> before = std::move(clusters_);
  clusters_.clear();
  std::vector<size_t> cluster_of(group_.bodies.size());
  for (uint32_t i = 0; i < group_.bodies.size(); ++i) {
    const uint32_t first = together_.first(i);
    if (first == i) {
      cluster_of[i] = clusters_.size();
      clusters_.emplace_back().group.reaches = reaches_;
      clusters_.back().strangers = together_.strangers_of(i);
    }
    cluster_of[i] = cluster_of[first];
    clusters_[cluster_of[i]].group.bodies.push_back(group_.bodies[i]);
  }
  auto old = before.begin();
  for (Cluster& c : clusters_) {
    while (old != before.end() && old->group.bodies.front() < c.group.bodies.front()) ++old;
    const bool same = old != before.end() && old->group.bodies == c.group.bodies;
    if (same && old->group.strays.empty()) c = std::move(*old++);
  }
  for (size_t k = 0; k < pairs_.size(); ++k) {
    const Watched& w = pairs_[k];
    if (!w.meets) continue;
    Cluster& c = clusters_[cluster_of[w.a != no_block ? w.a : w.b]];
    if (c.done) continue;
    c.pairs.push_back(k);
    c.group.pairs.push_back(w.pair);
    c.group.contacts.insert(c.group.contacts.end(), w.contacts.begin(), w.contacts.end());
  }
  for (size_t j = 0; j < group_.joints.size(); ++j) {
    Cluster& c = clusters_[cluster_of[joint_place_[j]]];
    if (!c.done) c.group.joints.push_back(group_.joints[j]);
  }
  for (uint32_t i = 0; i < group_.bodies.size(); ++i)
    if (!clusters_[cluster_of[i]].done) end_[i] = start_[i];
  put_bodies(end_);
}

bool GroupWindows::widen_reaches() {
  bool widened = false;
  for (const Cluster& c : clusters_)
    for (const auto& [slot, distance] : c.group.strays) {
      reaches_[slot].distance = distance;
      widened = true;
    }
  return widened;
}

Status GroupWindows::run_window(const TickPart& part) {
  start_ = end_ = motions();
  clusters_.clear();
  for (int tries = 0; within_group(h_ - part.begin); ++tries) {
    make_clusters();
    for (Cluster& c : clusters_) {
      if (c.done) continue;
      for (size_t i = 0; i < c.group.bodies.size(); ++i) block_of_[c.group.bodies[i]] = uint32_t(i);
      EventGroup moving(bodies_, c.group, block_of_, forces_, context_);
      c.status = moving.advance(part, c.stats);
      c.done = true;
    }
    if (!widen_reaches()) break;
    if (tries >= most_redone)
      return Error{ErrorCode::numeric, "bodies go farther in a window than could be foreseen",
                   context_.name(group_.bodies.front()), "use a smaller tick"};
    end_ = motions();
    put_bodies(start_);
    find_clusters(group_.bodies.size());
  }
  if (!group_.strays.empty()) return {};
  for (const Cluster& c : clusters_)
    if (!c.status) return c.status;
  return {};
}

void GroupWindows::add_books(const Cluster& cluster) {
  group_.books.add_causes(cluster.group.books);
  size_t row = 0;
  for (const uint32_t j : cluster.group.joints) {
    const auto which = std::lower_bound(group_.joints.begin(), group_.joints.end(), j);
    const size_t first = joint_row_[size_t(which - group_.joints.begin())];
    for (size_t k = 0; k < row_count(context_.joints[j].kind); ++k)
      group_.books.joint_impulses[first + k] += cluster.group.books.joint_impulses[row++];
  }
}

void GroupWindows::commit(EventStats& stats) {
  ++stats.windows;
  for (uint32_t i = 0; i < group_.bodies.size(); ++i) {
    const uint32_t slot = group_.bodies[i];
    gone_[i] += distance_gone(bodies_[slot], reaches_[slot]);
  }
  for (Watched& w : pairs_)
    if (!w.meets)
      for (EventContact& c : w.contacts) c.offset = 0;
  for (Cluster& c : clusters_) {
    stats.include(c.stats);
    add_books(c);
    for (size_t i = 0; i < c.pairs.size(); ++i) {
      Watched& w = pairs_[c.pairs[i]];
      w.pair = c.group.pairs[i];
      const auto first = c.group.contacts.begin() + std::ptrdiff_t(w.pair.first_contact);
      w.contacts.assign(first, first + std::ptrdiff_t(w.pair.contacts));
      w.measured = w.pair.gap.near;
      w.gap = w.measured ? w.pair.gap.gap : -std::numeric_limits<double>::infinity();
      w.gone = gone(w);
    }
  }
}

void GroupWindows::give_contacts() {
  group_.contacts.clear();
  for (const Watched& w : pairs_)
    if (w.meets)
      group_.contacts.insert(group_.contacts.end(), w.contacts.begin(), w.contacts.end());
}

size_t GroupWindows::coupling() const {
  size_t sum = 0;
  for (const Cluster& c : clusters_)
    if (c.strangers > 0) sum += c.group.bodies.size() * (c.stats.steps + c.stats.events);
  return sum;
}

/// Time of a number of units since the start of the tick.
double GroupWindows::time(uint32_t units) const {
  return units == whole ? h_ : h_ * units / whole;
}

uint32_t GroupWindows::next_window(uint32_t now, uint32_t length) {
  const size_t all = group_.bodies.size();
  if (now == 0) {
    while (!plan(length, length > 1 ? context_.most_strangers : all)) length /= 2;
    return length;
  }
  const size_t spent = coupling(), strangers = together_.strangers();
  if (spent > most_spent * all && length > 1) {
    length /= 2;
  } else if (spent < all && now % (2 * length) == 0) {
    if (plan(2 * length, 2 * strangers + few)) return 2 * length;
  }
  plan(length, all);
  return length;
}

Status GroupWindows::advance(double h, EventStats& stats) {
  h_ = h;
  take_pairs();
  uint32_t length = whole;
  for (uint32_t now = 0; now < whole; now += length) {
    length = next_window(now, length);
    const TickPart part{time(now), time(now + length), h};
    if (Status done = run_window(part); !done) return done;
    if (!group_.strays.empty()) return {};
    commit(stats);
  }
  give_contacts();
  return {};
}

}  // namespace tumble
