#include "engine/world/events/gather_events.hpp"

#include "engine/world/events/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

#include <fmt/format.h>

namespace tumble {
namespace {

WorldEvent event_in(const Frame& frame, WorldEventKind kind) {
  WorldEvent out;
  out.tick = frame.tick;
  out.time = frame.time;
  out.kind = kind;
  return out;
}

std::string name_in(const std::vector<BodyInfo>& infos, BodyId id) {
  const std::string& name = infos[id.index].name;
  return name.empty() ? fmt::format("body {}", id.index) : name;
}

/// Inverse of the mass of a body that impulses can move [1/kg]; 0 for others.
double inverse_mass(const BodyInfo& info) {
  return info.type == BodyType::dynamic && info.mass > 0 ? 1 / info.mass : 0;
}

/// Bodies with the same kind of event in a tick.
struct Group {
  std::vector<BodyId> bodies;

  void tell(const Frame& frame, WorldEventKind kind, const std::vector<BodyInfo>& infos,
            std::vector<WorldEvent>& out) const {
    const bool singly = bodies.size() <= tolerances::most_told_singly;
    for (size_t i = 0; i < (singly ? bodies.size() : 1); ++i) {
      WorldEvent e = event_in(frame, kind);
      e.a = bodies[i];
      e.name_a = name_in(infos, bodies[i]);
      e.count = singly ? 1 : bodies.size();
      out.push_back(std::move(e));
    }
  }
};

bool same_pair(const auto& p, const auto& q) {
  return p.a == q.a && p.b == q.b;
}

bool by_bodies(const auto& p, const auto& q) {
  return std::pair(p.a, p.b) < std::pair(q.a, q.b);
}

}  // namespace

std::vector<EventGatherer::PairPush> EventGatherer::pushes_of(const Frame& frame) {
  std::vector<PairPush> all;
  if (!frame.contacts) return all;
  for (const ContactFrame& c : *frame.contacts)  // bodies at rest have no impacts
    if (const double size = c.impulse.norm(); size > 0)
      all.push_back({c.a, c.b, c.impulse, size, c.x_world, c.normal});
  std::stable_sort(all.begin(), all.end(),
                   [](const PairPush& p, const PairPush& q) { return by_bodies(p, q); });
  size_t pairs = 0;
  for (const PairPush& next : all) {
    if (pairs == 0 || !same_pair(all[pairs - 1], next)) {
      all[pairs++] = next;
      continue;
    }
    PairPush& pair = all[pairs - 1];
    const Vec3 sum = pair.impulse + next.impulse;
    if (next.most > pair.most) pair = next;
    pair.impulse = sum;
  }
  all.resize(pairs);
  return all;
}

std::vector<EventGatherer::System> EventGatherer::systems_of(const Frame& frame) {
  std::vector<System> out;
  for (const auto& p : frame.particles)
    out.push_back({p->id, p->ids.empty() ? 0 : p->ids.back(), p->ids.size()});
  return out;
}

const BodyFrame* EventGatherer::before(BodyId id) const {
  const size_t chunk = id.index / Frame::chunk_size;
  if (id.is_null() || chunk >= chunks_.size()) return nullptr;
  const BodyFrame& body = (*chunks_[chunk])[id.index % Frame::chunk_size];
  return body.id == id ? &body : nullptr;
}

double EventGatherer::normal_speed(const PairPush& pair, const BodyFrame* a,
                                   const BodyFrame* b) const {
  const auto velocity = [&](const BodyFrame* body) -> Vec3 {
    if (!body) return Vec3::Zero();
    return body->v + body->omega.cross(pair.x - body->pose.x);
  };
  return std::fabs(pair.normal.dot(velocity(b) - velocity(a)));
}

void EventGatherer::find_impacts(const Frame& frame, const std::vector<PairPush>& now,
                                 std::vector<WorldEvent>& out) const {
  const double slow = std::max(tolerances::least_strike,
                               tolerances::strike_ticks * frame.usual_gravity * frame.rate.tick());
  std::vector<WorldEvent> found;
  for (const PairPush& pair : now) {
    const auto old =
        std::lower_bound(pushes_.begin(), pushes_.end(), pair,
                         [](const PairPush& p, const PairPush& q) { return by_bodies(p, q); });
    const bool known = old != pushes_.end() && same_pair(*old, pair);
    const double more = pair.impulse.norm() - (known ? old->impulse.norm() : 0);
    const double inverse =
        inverse_mass(frame.info(pair.a.index)) + inverse_mass(frame.info(pair.b.index));
    if (!(more * inverse > slow)) continue;
    const double then = normal_speed(pair, before(pair.a), before(pair.b));
    const double after = normal_speed(pair, &frame.body(pair.a.index), &frame.body(pair.b.index));
    if (!(std::max(then, after) > slow)) continue;
    WorldEvent e = event_in(frame, WorldEventKind::impact);
    e.a = pair.a;
    e.b = pair.b;
    e.name_a = name_in(*frame.infos, pair.a);
    e.name_b = name_in(*frame.infos, pair.b);
    e.impulse = more;
    e.x_world = pair.x;
    found.push_back(std::move(e));
  }
  std::ranges::stable_sort(found, std::greater(), &WorldEvent::impulse);
  if (found.size() > tolerances::most_impacts) found.resize(tolerances::most_impacts);
  std::ranges::move(found, std::back_inserter(out));
}

void EventGatherer::find_body_changes(const Frame& frame, std::vector<WorldEvent>& out) const {
  Group asleep, awake, born, dead;
  const size_t chunks = std::max(chunks_.size(), frame.chunks.size());
  static const Frame::BodyChunk nobody{};
  for (size_t c = 0; c < chunks; ++c) {
    const bool was = c < chunks_.size(), is = c < frame.chunks.size();
    if (was && is && chunks_[c] == frame.chunks[c]) continue;
    const Frame::BodyChunk& old = was ? *chunks_[c] : nobody;
    const Frame::BodyChunk& now = is ? *frame.chunks[c] : nobody;
    for (size_t i = 0; i < Frame::chunk_size; ++i) {
      if (old[i].id != now[i].id) {
        if (old[i].id) dead.bodies.push_back(old[i].id);
        if (now[i].id) born.bodies.push_back(now[i].id);
      } else if (now[i].id && old[i].asleep != now[i].asleep) {
        (now[i].asleep ? asleep : awake).bodies.push_back(now[i].id);
      }
    }
  }
  asleep.tell(frame, WorldEventKind::fell_asleep, *frame.infos, out);
  awake.tell(frame, WorldEventKind::woke, *frame.infos, out);
  born.tell(frame, WorldEventKind::births, *frame.infos, out);
  dead.tell(frame, WorldEventKind::deaths, *infos_, out);
}

void EventGatherer::find_broken(const Frame& frame, std::vector<WorldEvent>& out) const {
  if (frame.stats.broken_joints == 0 || !joints_ || !frame.joints) return;
  auto now = frame.joints->begin();  // both in the order of their slots
  for (const JointFrame& j : *joints_) {
    while (now != frame.joints->end() && now->id < j.id) ++now;
    if (now != frame.joints->end() && now->id == j.id) continue;
    WorldEvent e = event_in(frame, WorldEventKind::joint_broken);
    e.a = j.a;
    e.b = j.b;
    e.name_a = j.name.empty() ? fmt::format("joint {}", j.id.index) : j.name;
    e.x_world = j.frame_b.x;
    out.push_back(std::move(e));
  }
}

void EventGatherer::find_particles(const Frame& frame, const std::vector<System>& now,
                                   std::vector<WorldEvent>& out) const {
  for (size_t k = 0; k < now.size(); ++k) {
    const auto old = std::ranges::find(systems_, now[k].id, &System::id);
    if (old == systems_.end()) continue;
    const ParticleFrame& p = *frame.particles[k];
    const auto first_new = std::ranges::upper_bound(p.ids, old->last_id);
    const auto born = uint64_t(p.ids.end() - first_new);
    const uint64_t dead = old->count + born - now[k].count;
    for (const auto& [kind, count] :
         {std::pair{WorldEventKind::births, born}, {WorldEventKind::deaths, dead}}) {
      if (count == 0) continue;
      WorldEvent e = event_in(frame, kind);
      e.name_a = p.name;
      e.count = count;
      out.push_back(std::move(e));
    }
  }
}

void EventGatherer::go_to(const Frame& frame) {
  chunks_ = frame.chunks;
  infos_ = frame.infos;
  joints_ = frame.joints;
  pushes_ = pushes_of(frame);
  systems_ = systems_of(frame);
}

std::vector<WorldEvent> EventGatherer::see(const Frame& frame) {
  std::vector<WorldEvent> out;
  std::vector<PairPush> pushes = pushes_of(frame);
  const std::vector<System> systems = systems_of(frame);
  find_impacts(frame, pushes, out);
  find_broken(frame, out);
  find_body_changes(frame, out);
  find_particles(frame, systems, out);
  if (frame.stats.time_stepped > 0) {
    WorldEvent e = event_in(frame, WorldEventKind::time_stepped);
    e.count = frame.stats.time_stepped;
    out.push_back(std::move(e));
  }
  chunks_ = frame.chunks;
  infos_ = frame.infos;
  joints_ = frame.joints;
  pushes_ = std::move(pushes);
  systems_ = systems;
  return out;
}

}  // namespace tumble
