#include "engine/dynamics/event/group_windows.hpp"

#include "engine/core/crew.hpp"
#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/dynamics/event/event_group.hpp"
#include "engine/dynamics/event/tolerances.hpp"

#include <algorithm>

namespace tumble {
namespace {

uint32_t place_of(const BodyGroup& group, uint32_t slot) {
  const auto at = std::lower_bound(group.bodies.begin(), group.bodies.end(), slot);
  if (at == group.bodies.end() || *at != slot) return no_block;
  return uint32_t(at - group.bodies.begin());
}

}  // namespace

void WindowReaches::reset(size_t slots) {
  for (std::vector<BodyReach>& r : by_depth) r.assign(slots, {});
  pace.assign(slots, 0);
}

bool GroupWindows::scattered(const BodyGroup& group, const EventContext& context) {
  if (group.bodies.size() <= context.max_untied_bodies + 1) return false;
  BodyClusters tied;
  tied.reset(group.bodies.size());
  const auto place = [&](uint32_t slot) { return place_of(group, slot); };
  for (const auto& [a, b] : group.ties) tied.tie(place(a), place(b));
  for (const EventContact& c : group.contacts) {
    const uint32_t a = place(c.key.body_a), b = place(c.key.body_b);
    if (c.closed && a != no_block && b != no_block) tied.tie(a, b);
  }
  for (uint32_t i = 1; i < group.bodies.size(); ++i) tied.meet(0, i);
  return tied.crowded(0, context.max_untied_bodies);
}

GroupWindows::GroupWindows(std::span<RigidBody> bodies, BodyGroup& group,
                           std::span<uint32_t> block_of, WindowReaches& reaches,
                           const SmoothForces& forces, const EventContext& context, Crew& crew,
                           int depth)
    : bodies_(bodies),
      group_(group),
      block_of_(block_of),
      all_reaches_(reaches),
      reaches_(reaches.by_depth[size_t(depth)]),
      forces_(forces),
      context_(context),
      crew_(crew),
      depth_(depth),
      pairs_(watched_pairs(group, block_of)),
      gone_(group.bodies.size(), 0) {
  for (const uint32_t slot : group.bodies) halves_.push_back(box_about(bodies[slot]));
  for (const auto& [a, b] : group.ties) ties_.emplace_back(block_of[a], block_of[b]);
  for (const uint32_t j : group.joints) {
    const Joint& joint = context.joints[j];
    const bool at_a = joint.a != no_body && block_of[joint.a] != no_block;
    joint_place_.push_back(block_of[at_a ? joint.a : joint.b]);
  }
  for (const uint32_t k : group.couplings)
    coupling_place_.push_back(
        block_of[first_body(context.couplings[k], context.joints, [&](uint32_t slot) {
          return block_of[slot] != no_block && bodies[slot].dynamic();
        })]);
  group.books.joints.resize(group.joints.size());
  group.books.couplings.resize(group.couplings.size());
}

double GroupWindows::max_displacement(const WatchedPair& w) const {
  return (w.a == no_block ? 0 : gone_[w.a]) + (w.b == no_block ? 0 : gone_[w.b]);
}

void GroupWindows::guess_reaches(const TickPart& part) {
  for (uint32_t i = 0; i < group_.bodies.size(); ++i) {
    const uint32_t slot = group_.bodies[i];
    reaches_[slot] =
        guess_reach(bodies_[slot], halves_[i], context_.gravity, part.end - part.begin, part.tick);
  }
}

bool GroupWindows::within(WatchedPair& w, double distance) {
  if (w.least_gap(max_displacement(w)) > distance) return false;
  if (!w.measured || max_displacement(w) > w.max_displacement)
    w.look(bodies_, context_.hierarchy, tolerances::looks_ahead * distance, max_displacement(w));
  return !(w.gap > distance);
}

bool GroupWindows::may_meet(WatchedPair& w) {
  return within(w, reaches_[w.pair.a.body].distance + reaches_[w.pair.b.body].distance +
                       tolerances::between_windows);
}

void GroupWindows::find_clusters() {
  together_.reset(group_.bodies.size());
  for (const auto& [a, b] : ties_) together_.tie(a, b);
  for (const WatchedPair& w : pairs_)
    if (w.both_move() && w.closed()) together_.tie(w.a, w.b);
  for (WatchedPair& w : pairs_) {
    w.meets = may_meet(w);
    if (w.meets && w.both_move()) together_.meet(w.a, w.b);
  }
}

std::vector<BodyMotion> GroupWindows::motions() const {
  std::vector<BodyMotion> out;
  for (const uint32_t slot : group_.bodies) out.push_back(motion_of(bodies_[slot]));
  return out;
}

void GroupWindows::put_bodies(std::span<const BodyMotion> motions) {
  for (size_t i = 0; i < motions.size(); ++i) put_motion(motions[i], bodies_[group_.bodies[i]]);
}

void GroupWindows::make_clusters() {
  std::vector<Cluster> before = std::move(clusters_);
  clusters_.clear();
  std::vector<size_t> cluster_of(group_.bodies.size());
  for (uint32_t i = 0; i < group_.bodies.size(); ++i) {
    const uint32_t first = together_.first(i);
    if (first == i) {
      cluster_of[i] = clusters_.size();
      clusters_.emplace_back().crowd = depth_ < tolerances::most_window_halvings &&
                                       together_.crowded(i, context_.max_untied_bodies);
    }
    cluster_of[i] = cluster_of[first];
    clusters_[cluster_of[i]].group.bodies.push_back(group_.bodies[i]);
  }
  for (size_t k = 0; k < pairs_.size(); ++k) {
    const WatchedPair& w = pairs_[k];
    if (w.meets) clusters_[cluster_of[w.a != no_block ? w.a : w.b]].pairs.push_back(k);
  }
  for (size_t j = 0; j < group_.joints.size(); ++j)
    clusters_[cluster_of[joint_place_[j]]].group.joints.push_back(group_.joints[j]);
  for (size_t k = 0; k < group_.couplings.size(); ++k)
    clusters_[cluster_of[coupling_place_[k]]].group.couplings.push_back(group_.couplings[k]);
  auto old = before.begin();
  for (Cluster& c : clusters_) {
    while (old != before.end() && old->group.bodies.front() < c.group.bodies.front()) ++old;
    const bool same = old != before.end() && old->group.bodies == c.group.bodies &&
                      old->pairs == c.pairs && old->status;
    if (same)
      c = std::move(*old++);
    else
      fill(c);
  }
  for (uint32_t i = 0; i < group_.bodies.size(); ++i)
    if (!clusters_[cluster_of[i]].done) end_[i] = start_[i];
  put_bodies(end_);
}

void GroupWindows::fill(Cluster& c) const {
  c.group.reaches = reaches_;
  c.group.ties.clear();
  for (const auto& tie : group_.ties)
    if (place_of(c.group, tie.first) != no_block) c.group.ties.push_back(tie);
  for (const size_t k : c.pairs) {
    const WatchedPair& w = pairs_[k];
    c.group.pairs.push_back(w.pair);
    c.group.contacts.insert(c.group.contacts.end(), w.contacts.begin(), w.contacts.end());
  }
}

void GroupWindows::start_again(Cluster& c) {
  c.group.pairs.clear();
  c.group.contacts.clear();
  c.group.books = {};
  c.group.crushed = false;
  const uint64_t work = c.stats.work;
  c.stats = {};
  c.stats.work = work;
  fill(c);
  for (const uint32_t slot : c.group.bodies)
    put_motion(start_[place_of(group_, slot)], bodies_[slot]);
}

void GroupWindows::note_pace(const Cluster& c, double seconds) {
  for (const uint32_t slot : c.group.bodies)
    all_reaches_.pace[slot] = double(c.stats.steps) / seconds;
}

bool GroupWindows::takes_few_steps(const Cluster& c, double seconds) const {
  return std::all_of(c.group.bodies.begin(), c.group.bodies.end(), [&](uint32_t slot) {
    return all_reaches_.pace[slot] * seconds <= double(tolerances::few_steps);
  });
}

bool GroupWindows::run_whole(Cluster& c, const TickPart& part) {
  const double seconds = part.end - part.begin;
  if (c.crowd && !takes_few_steps(c, seconds)) return false;
  EventGroup moving(bodies_, c.group, block_of_, forces_, context_);
  c.status =
      moving.advance(part, c.stats, c.crowd ? tolerances::few_steps : EventGroup::any_number);
  const std::optional<double> given_up = c.group.given_up;
  note_pace(c, given_up ? *given_up - part.begin : seconds);
  return !c.crowd || (c.status && !given_up);
}

void GroupWindows::run(Cluster& c, const TickPart& part) {
  for (size_t i = 0; i < c.group.bodies.size(); ++i) block_of_[c.group.bodies[i]] = uint32_t(i);
  c.done = true;
  if (run_whole(c, part) || stop_requested()) return;
  // The budget is exceeded already: halves would only cost more.
  if (!c.status && c.stats.work > context_.allowed_work(bodies_, c.group.bodies, part.tick)) return;
  start_again(c);
  c.status =
      GroupWindows(bodies_, c.group, block_of_, all_reaches_, forces_, context_, crew_, depth_ + 1)
          .advance(part, c.stats);
}

/// Widens the reaches in clusters that will be halved, whose bodies hit each other and become
/// faster: to repeat such a window costs more than a few clusters too large.
void GroupWindows::foresee_crowds() {
  if (depth_ >= tolerances::most_window_halvings) return;
  for (uint32_t i = 0; i < group_.bodies.size(); ++i)
    if (together_.crowded(together_.first(i), context_.max_untied_bodies))
      reaches_[group_.bodies[i]].distance *= tolerances::crowd_spare;
  find_clusters();
}

std::vector<double> GroupWindows::gone_in_window() const {
  std::vector<double> out(group_.bodies.size());
  for (const Cluster& c : clusters_)
    for (size_t i = 0; i < c.group.bodies.size(); ++i)
      out[place_of(group_, c.group.bodies[i])] = c.group.max_displacement[i];
  return out;
}

bool GroupWindows::missed_any(std::span<const double> gone_now) {
  const auto gone_by = [&](uint32_t place) { return place == no_block ? 0 : gone_now[place]; };
  const auto strayed = [&](uint32_t place, uint32_t slot) {
    return gone_by(place) > reaches_[slot].distance;
  };
  bool missed = false;
  for (WatchedPair& w : pairs_) {
    const bool a = strayed(w.a, w.pair.a.body), b = strayed(w.b, w.pair.b.body);
    if (w.meets || !(a || b)) continue;
    const double both = gone_by(w.a) + gone_by(w.b) + tolerances::between_windows;
    missed |= within(w, both);
  }
  if (!missed) return false;
  for (uint32_t i = 0; i < group_.bodies.size(); ++i) {
    double& distance = reaches_[group_.bodies[i]].distance;
    if (gone_now[i] > distance) distance = tolerances::window_surplus * gone_now[i];
  }
  return true;
}

Status GroupWindows::run_window(const TickPart& part, EventStats& stats) {
  WorkMeter own;
  const auto counted = [&own](const auto& work) {
    const Metered scope(own);
    return work();
  };
  counted([&] {
    guess_reaches(part);
    find_clusters();
    foresee_crowds();
  });
  start_ = end_ = motions();
  std::vector<double> gone_before;
  for (const uint32_t slot : group_.bodies)
    gone_before.push_back(displacement_bound(bodies_[slot], group_.reaches[slot]));
  clusters_.clear();
  std::vector<double> gone_now;
  for (;;) {
    counted([&] { make_clusters(); });
    std::vector<Cluster*> open;
    for (Cluster& c : clusters_)
      if (!c.done) open.push_back(&c);
    crew_.each(open.size(), [&](size_t i) { run(*open[i], part); });
    if (stop_requested()) return stopped_error();
    for (const Cluster* c : open) stats.work += c->stats.work;
    end_ = motions();
    gone_now = gone_in_window();
    put_bodies(start_);
    if (!counted([&] { return missed_any(gone_now); })) break;
    if (stats.work + own.spent() > context_.allowed_work(bodies_, group_.bodies, part.tick))
      return too_much();
    counted([&] { find_clusters(); });
  }
  stats.work += own.spent();
  put_bodies(end_);
  for (const Cluster& c : clusters_) {
    if (c.status) continue;
    group_.crushed = c.group.crushed;
    return c.status;
  }
  for (size_t i = 0; i < group_.bodies.size(); ++i)
    group_.max_displacement[i] = std::max(group_.max_displacement[i], gone_before[i] + gone_now[i]);
  commit(stats);
  if (stats.work > context_.allowed_work(bodies_, group_.bodies, part.tick)) return too_much();
  return {};
}

Error GroupWindows::too_much() const {
  return {ErrorCode::numeric, "too much happens in one tick", context_.name(group_.bodies.front()),
          "use a smaller tick, or a larger event.budget"};
}

void GroupWindows::add_books(const Cluster& cluster) {
  group_.books.add_causes(cluster.group.books);
  const auto place = [](const std::vector<uint32_t>& all, uint32_t one) {
    return size_t(std::lower_bound(all.begin(), all.end(), one) - all.begin());
  };
  const BodyGroup& part = cluster.group;
  for (size_t i = 0; i < part.joints.size(); ++i)
    group_.books.joints[place(group_.joints, part.joints[i])].add(part.books.joints[i]);
  for (size_t i = 0; i < part.couplings.size(); ++i)
    group_.books.couplings[place(group_.couplings, part.couplings[i])] += part.books.couplings[i];
}

void GroupWindows::commit(EventStats& stats) {
  ++stats.windows;
  for (uint32_t i = 0; i < group_.bodies.size(); ++i) {
    const uint32_t slot = group_.bodies[i];
    gone_[i] += displacement_bound(bodies_[slot], reaches_[slot]);
  }
  for (WatchedPair& w : pairs_)
    if (!w.meets)
      for (EventContact& c : w.contacts) c.offset = 0;
  for (const Cluster& c : clusters_) {
    EventStats counted = c.stats;
    counted.work = 0;  // the work, with that of attempts that were given up, is counted already
    stats.include(counted);
    add_books(c);
    for (size_t i = 0; i < c.pairs.size(); ++i) {
      WatchedPair& w = pairs_[c.pairs[i]];
      w.take(c.group.pairs[i], c.group.contacts, max_displacement(w));
    }
  }
}

Status GroupWindows::advance(const TickPart& part, EventStats& stats) {
  group_.max_displacement.assign(group_.bodies.size(), 0);
  const double mid = 0.5 * (part.begin + part.end);
  if (depth_ == 0) {
    if (Status done = run_window(part, stats); !done) return done;
  } else {
    for (const TickPart& half :
         {TickPart{part.begin, mid, part.tick}, TickPart{mid, part.end, part.tick}})
      if (Status done = run_window(half, stats); !done) return done;
  }
  give_back(pairs_, gone_, group_);
  return {};
}

}  // namespace tumble
