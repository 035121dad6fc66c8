#include "engine/dynamics/event/event_stepper.hpp"

#include "engine/core/crew.hpp"
#include "engine/core/registry.hpp"
#include "engine/core/stop.hpp"
#include "engine/dynamics/event/event_group.hpp"
#include "engine/dynamics/event/group_windows.hpp"
#include "engine/dynamics/event/tolerances.hpp"

#include <algorithm>
#include <unordered_set>

namespace tumble {
namespace {

std::vector<BodyMotion> motions_of(std::span<const RigidBody> bodies) {
  std::vector<BodyMotion> out;
  for (const RigidBody& b : bodies) out.push_back(motion_of(b));
  return out;
}

/// Where it is proved that no motion exists, time-stepping could not help either, and the error
/// stands.
bool can_be_time_stepped(const BodyGroup& group, const EventContext& context) {
  return context.time_stepping && !group.crushed;
}

void put_bodies(std::span<const BodyMotion> motions, std::span<RigidBody> bodies) {
  for (size_t i = 0; i < bodies.size(); ++i) put_motion(motions[i], bodies[i]);
}

/// Stores mean forces over the tick, which can be read, and from which the realtime stepper starts.
void tell_joint_forces(const BodyGroup& group, double h, std::span<Joint> joints,
                       std::span<JointCoupling> couplings) {
  for (size_t i = 0; i < group.joints.size(); ++i) {
    Joint& joint = joints[group.joints[i]];
    const JointImpulses& did = group.books.joints[i];
    joint.relaxing_force.fill(0);
    for (size_t k = 0; k < did.rows.size(); ++k) joint.moving_force[k] = did.rows[k] / h;
    joint.motor_impulse = did.motors;
  }
  for (size_t i = 0; i < group.couplings.size(); ++i) {
    couplings[group.couplings[i]].moving_force = group.books.couplings[i] / h;
    couplings[group.couplings[i]].relaxing_force = 0;
  }
}

}  // namespace

void EventStepper::build_groups(std::span<const RigidBody> bodies, const JointsAndCouplings& held,
                                std::span<const BodyLink> links) {
  const auto moves = [&](uint32_t slot) { return slot != no_body && travels(bodies[slot]); };
  DisjointSets sets(bodies.size());
  const auto join = [&](uint32_t a, uint32_t b) {
    if (moves(a) && moves(b)) sets.join(a, b);
  };
  for (const ProxyPair& p : pairs_) join(proxies_.refs[p.a].body, proxies_.refs[p.b].body);
  for (const BodyLink& l : links) join(l.a, l.b);

  groups_.clear();
  group_of_.assign(bodies.size(), no_block);
  block_of_.assign(bodies.size(), no_block);
  for (uint32_t slot = 0; slot < bodies.size(); ++slot) {
    if (!moves(slot)) continue;
    const uint32_t root = sets.root(slot);
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
  for (const ProxyPair& p : pairs_) {
    ShapeRef a = proxies_.refs[p.a], b = proxies_.refs[p.b];
    if (a.body == b.body || (!bodies[a.body].dynamic() && !bodies[b.body].dynamic())) continue;
    // time-stepping finds the pairs among its bodies itself
    if (carried_[a.body] && carried_[b.body]) continue;
    if (b.body < a.body) std::swap(a, b);
    groups_[group_of(a.body, b.body)].pairs.push_back({a, b, 0});
  }
  for (const BodyLink& l : links) {
    if (moves(l.a) && moves(l.b)) groups_[group_of_[l.a]].ties.emplace_back(l.a, l.b);
    if (l.joint == BodyLink::none) continue;
    const bool at_a = moves(l.a) && bodies[l.a].dynamic();
    if (!at_a && !bodies[l.b].dynamic()) continue;
    groups_[group_of_[at_a ? l.a : l.b]].joints.push_back(l.joint);
  }
  const auto moves_freely = [&](uint32_t slot) { return moves(slot) && bodies[slot].dynamic(); };
  for (uint32_t k = 0; k < held.couplings.size(); ++k) {
    const uint32_t slot = first_body(held.couplings[k], held.joints, moves_freely);
    if (slot != no_body) groups_[group_of_[slot]].couplings.push_back(k);
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
  for (BodyGroup& g : groups_)
    g.time_stepped = std::ranges::any_of(g.bodies, [&](uint32_t s) { return carried_[s]; });
}

Status EventStepper::run_groups(std::span<RigidBody> bodies, const SmoothForces& forces,
                                const EventContext& context, double h, Crew& crew) {
  counted_.assign(groups_.size(), {});
  for (size_t i = 0; i < groups_.size(); ++i)
    for (const uint32_t slot : groups_[i].bodies) counted_[i].work += spent_[slot];
  std::vector<Status> done(groups_.size());
  bool any = false;
  // Equations are kept for the groups of this attempt only; those of other groups may be laid out
  // differently.
  std::unordered_set<uint32_t> fronts;
  for (const BodyGroup& g : groups_)
    if (!g.joints.empty()) fronts.insert(g.joints.front());
  std::erase_if(laid_out_, [&](const auto& l) { return !fronts.contains(l.first); });
  for (BodyGroup& g : groups_)
    if (!g.joints.empty()) g.laid_out = &laid_out_[g.joints.front()];
  for (BodyGroup& g : groups_)
    any |= g.scattered = !g.time_stepped && GroupWindows::scattered(g, context);
  EventContext of_retries = context;
  of_retries.budget_share = tolerances::retried_share;
  if (any) window_reaches_.reset(bodies.size());
  crew.each(groups_.size(), [&](size_t i) {
    BodyGroup& group = groups_[i];
    if (stop_requested() || group.time_stepped) return;
    const bool again = std::ranges::any_of(
        group.bodies, [this](uint32_t slot) { return time_stepped[slot].last > 0; });
    const EventContext& given = again ? of_retries : context;
    if (group.scattered)
      done[i] = GroupWindows(bodies, group, block_of_, window_reaches_, forces, given, crew)
                    .advance({0, h, h}, counted_[i]);
    else
      done[i] = EventGroup(bodies, group, block_of_, forces, given).advance({0, h, h}, counted_[i]);
  });
  note_spent();
  for (size_t i = 0; i < groups_.size(); ++i) {
    if (done[i]) continue;
    if (!can_be_time_stepped(groups_[i], context)) return done[i];
    groups_[i].time_stepped = true;
  }
  return {};
}

/// Charges the work of groups to their bodies in equal shares, so that a tick that is computed
/// again with other groups does not get a new budget.
void EventStepper::note_spent() {
  for (size_t i = 0; i < groups_.size(); ++i) {
    const std::vector<uint32_t>& slots = groups_[i].bodies;
    const uint64_t share = counted_[i].work / slots.size();
    for (const uint32_t slot : slots) spent_[slot] = share;
    spent_[slots.front()] += counted_[i].work % slots.size();
  }
}

/// Time-steps all groups that are marked, together.
Status EventStepper::time_step(std::span<RigidBody> bodies, const EventContext& context) {
  std::vector<uint32_t> slots;
  for (size_t i = 0; i < groups_.size(); ++i) {
    BodyGroup& g = groups_[i];
    if (!g.time_stepped) continue;
    slots.insert(slots.end(), g.bodies.begin(), g.bodies.end());
    // Overlap that is left becomes accepted depth when events continue from there.
    g.contacts.clear();
    g.books = {};
    const uint64_t work = counted_[i].work;
    counted_[i] = {};
    counted_[i].work = work;
    counted_[i].time_stepped = 1;
  }
  if (slots.empty()) return {};
  std::ranges::sort(slots);
  for (const uint32_t slot : slots) {
    put_motion(start_[slot], bodies[slot]);
    carried_[slot] = true;
  }
  if (const Status done = context.time_stepping->advance(slots); !done) return done;
  for (BodyGroup& g : groups_) {
    if (!g.time_stepped) continue;
    g.max_displacement.clear();
    for (const uint32_t slot : g.bodies)
      g.max_displacement.push_back(displacement_bound(bodies[slot], reaches_[slot]));
  }
  return {};
}

Status EventStepper::move_groups(std::span<RigidBody> bodies, const SmoothForces& forces,
                                 const EventContext& context, double h, Crew& crew) {
  if (const Status done = run_groups(bodies, forces, context, h, crew); !done) return done;
  if (stop_requested()) return stopped_error();
  return time_step(bodies, context);
}

void TimeSteppedTicks::fail() {
  last = std::min<uint8_t>(tolerances::most_waited_ticks,
                           last == 0 ? tolerances::first_waited_ticks : uint8_t(2 * last));
  left = last;
}

/// Updates for how many ticks bodies will be time-stepped.
void EventStepper::note_time_stepped() {
  time_stepped.resize(carried_.size());
  for (const BodyGroup& g : groups_) {
    const bool waited =
        std::ranges::any_of(g.bodies, [&](uint32_t slot) { return time_stepped[slot].left > 0; });
    for (const uint32_t slot : g.bodies) {
      TimeSteppedTicks& ticks = time_stepped[slot];
      if (!g.time_stepped)
        ticks = {};
      else if (!waited)
        ticks.fail();
      else if (ticks.left > 0)
        --ticks.left;
    }
  }
}

/// Widens the reaches of bodies in crowds, which hit each other and become faster. Returns whether
/// there are any.
bool EventStepper::foresee_crowds(const EventContext& context) {
  bool any = false;
  for (const BodyGroup& g : groups_) {
    if (g.time_stepped || !GroupWindows::scattered(g, context)) continue;
    for (const uint32_t slot : g.bodies) reaches_[slot].distance *= tolerances::group_spare;
    any = true;
  }
  return any;
}

/// Widens the reaches of bodies that moved farther. Groups without such a body are computed again
/// only because of others, and get their whole budget back. Returns whether any was widened.
bool EventStepper::widen_reaches() {
  bool widened = false;
  for (const BodyGroup& g : groups_) {
    // A group to be time-stepped has not moved if the failure of another group ended the attempt.
    if (g.max_displacement.size() != g.bodies.size()) continue;
    bool strayed = false;
    for (size_t i = 0; i < g.bodies.size(); ++i) {
      BodyReach& reach = reaches_[g.bodies[i]];
      if (!(g.max_displacement[i] > reach.distance)) continue;
      reach.distance = tolerances::group_surplus * g.max_displacement[i];
      strayed = true;
    }
    if (!strayed)
      for (const uint32_t slot : g.bodies) spent_[slot] = 0;
    widened |= strayed;
  }
  return widened;
}

/// Whether the present reaches give the same pairs as before. The bodies must be where they
/// started.
bool EventStepper::found_all(std::span<const RigidBody> bodies, BroadPhase& broad_phase,
                             const PairFilter& apart) {
  const std::vector<ProxyPair> found = pairs_;
  find_pairs(bodies, broad_phase, apart);
  return pairs_ == found;
}

void EventStepper::find_pairs(std::span<const RigidBody> bodies, BroadPhase& broad_phase,
                              const PairFilter& apart) {
  reach_proxies(bodies, reaches_, proxies_);
  broad_phase.set_owners(proxies_.owners);
  broad_phase.find_pairs(proxies_.proxies, pairs_);
  apart.apply(proxies_, pairs_);
  std::sort(pairs_.begin(), pairs_.end());
}

Status EventStepper::step(std::span<RigidBody> bodies, BroadPhase& broad_phase,
                          std::span<const BodyLink> links, const SmoothForces& forces,
                          EventContext context, double h, Crew& crew) {
  const auto law = find_named(all_impact_laws(), context.settings.impulses, "law of impulses");
  if (!law) return law.error();
  context.law = (*law)->resolve;
  if (!context.time_stepping) context.settings.budget = tolerances::patient_budget;
  const auto method =
      contact_force_method(context.settings.contact_solver, context.settings.friction_cone);
  if (!method) return method.error();
  context.forces = *method;
  std::vector<uint32_t> moving;
  for (uint32_t slot = 0; slot < bodies.size(); ++slot)
    if (travels(bodies[slot])) moving.push_back(slot);
  forces(0, moving);
  for (const uint32_t slot : moving)
    if (!bodies[slot].force.allFinite() || !bodies[slot].torque.allFinite())
      return Error{ErrorCode::numeric, "the force on a body is not finite", context.name(slot),
                   "use softer springs or smaller distances"};
  reaches_ = guess_reaches(bodies, context.gravity, h);
  start_ = motions_of(bodies);
  carried_.assign(bodies.size(), false);
  spent_.assign(bodies.size(), 0);
  time_stepped.resize(bodies.size());
  for (const uint32_t slot : moving)
    carried_[slot] = context.time_stepping && time_stepped[slot].left > 0;
  for (int tries = 0;; ++tries) {
    if (context.search) context.search->searches.clear();
    find_pairs(bodies, broad_phase, context.apart);
    if (auto crowd = tries == 0 ? find_crowd(proxies_, pairs_) : std::nullopt) {
      crowd->error.place = "about " + context.name(crowd->slot);
      // Too many pairs for events: all bodies are time-stepped, whose bounds are only those of the
      // tick's motion.
      if (!context.time_stepping) return crowd->error;
      for (const uint32_t slot : moving) carried_[slot] = true;
    }
    build_groups(bodies, {context.joints, context.couplings}, links);
    if (tries == 0 && foresee_crowds(context)) continue;
    for (BodyGroup& g : groups_) g.reaches = reaches_;
    const Status done = move_groups(bodies, forces, context, h, crew);
    if (stop_requested()) return stopped_error();
    if (!widen_reaches()) {
      if (!done) return done;
      break;
    }
    const std::vector<BodyMotion> end = motions_of(bodies);
    put_bodies(start_, bodies);
    if (found_all(bodies, broad_phase, context.apart)) {
      if (!done) return done;
      put_bodies(end, bodies);
      break;
    }
  }
  note_time_stepped();
  if (context.search)
    for (const BodyGroup& g : groups_)
      if (g.time_stepped && std::ranges::find(g.bodies, context.search->body) != g.bodies.end())
        context.search->searches.clear();  // of the attempt that was given up
  for (const CourseMotion& c : context.courses) {
    const BodyVelocity at_end = c.at(h);
    bodies[c.slot].v = at_end.v;
    bodies[c.slot].omega = at_end.omega;
  }
  turned.assign(context.joints.size(), std::nullopt);
  for (const BodyGroup& g : groups_)
    for (size_t i = 0; i < g.joints.size() && !g.time_stepped; ++i)
      turned[g.joints[i]] = g.books.joints[i].turned;
  for (const BodyGroup& g : groups_)
    if (!g.time_stepped) tell_joint_forces(g, h, context.joints, context.couplings);
  books.clear();
  if (context.rates)
    for (BodyGroup& g : groups_) books.push_back(std::move(g.books));
  stats = {};
  stats.groups = groups_.size();
  stats.pairs = pairs_.size();
  contacts.clear();
  for (size_t i = 0; i < groups_.size(); ++i) {
    stats.include(counted_[i]);
    contacts.insert(contacts.end(), groups_[i].contacts.begin(), groups_[i].contacts.end());
  }
  return {};
}

void EventStepper::remove_body(uint32_t body) {
  std::erase_if(contacts, [body](const EventContact& c) {
    return c.key.body_a == body || c.key.body_b == body;
  });
  if (body < time_stepped.size()) time_stepped[body] = {};
}

namespace {

void save_ticks(ByteWriter& out, const TimeSteppedTicks& ticks) {
  out.value(ticks.left);
  out.value(ticks.last);
}
void load_ticks(ByteReader& in, TimeSteppedTicks& ticks) {
  in.value(ticks.left);
  in.value(ticks.last);
}

}  // namespace

void EventStepper::save(ByteWriter& out) const {
  tumble::save(out, particles);
  out.value(uint64_t(contacts.size()));
  for (const EventContact& c : contacts) {
    out.value(c.key.body_a);
    out.value(c.key.shape_a);
    out.value(c.key.body_b);
    out.value(c.key.shape_b);
    out.value(c.key.part);
    out.value(c.feature);
    for (const SurfaceElement* e : {&c.a, &c.b}) {
      out.value(e->kind);
      out.value(e->origin);
      out.value(e->direction);
      out.value(e->radius);
      if (e->kind == ElementKind::ellipsoid) out.value(e->semi_axes);
      if (e->kind == ElementKind::cone) out.value(e->taper);
    }
    out.value(c.towards_b);
    out.value(c.friction);
    out.value(c.restitution);
    out.value(c.surface_velocity);
    out.value(c.offset);
    out.value(uint8_t{c.closed});
    out.value(c.force);
  }
  out.value(uint64_t(time_stepped.size()));
  for (const TimeSteppedTicks& ticks : time_stepped) save_ticks(out, ticks);
  out.value(uint64_t(time_stepped_particles.size()));
  for (const TimeSteppedParticle& p : time_stepped_particles) {
    out.value(p.particle.system);
    out.value(p.particle.particle);
    save_ticks(out, p.ticks);
  }
}

bool EventStepper::load(ByteReader& in, uint32_t body_slots) {
  contacts.clear();
  particles = load_particle_names(in);
  const auto count = in.get<uint64_t>();
  for (uint64_t k = 0; k < count && in.ok(); ++k) {
    EventContact c;
    in.value(c.key.body_a);
    in.value(c.key.shape_a);
    in.value(c.key.body_b);
    in.value(c.key.shape_b);
    in.value(c.key.part);
    in.value(c.feature);
    for (SurfaceElement* e : {&c.a, &c.b}) {
      in.value(e->kind);
      in.value(e->origin);
      in.value(e->direction);
      in.value(e->radius);
      if (e->kind > ElementKind::cone) in.fail();
      if (e->kind == ElementKind::ellipsoid) in.value(e->semi_axes);
      if (e->kind == ElementKind::cone) in.value(e->taper);
    }
    in.value(c.towards_b);
    in.value(c.friction);
    in.value(c.restitution);
    in.value(c.surface_velocity);
    in.value(c.offset);
    c.closed = in.get<uint8_t>() != 0;
    in.value(c.force);
    for (const uint32_t slot : {c.key.body_a, c.key.body_b})
      if (!known_slot(slot, body_slots, particles)) in.fail();
    contacts.push_back(c);
  }
  time_stepped.clear();
  const auto remembered = in.get<uint64_t>();
  for (uint64_t k = 0; k < remembered && in.ok(); ++k) load_ticks(in, time_stepped.emplace_back());
  time_stepped_particles.clear();
  const auto of_particles = in.get<uint64_t>();
  for (uint64_t k = 0; k < of_particles && in.ok(); ++k) {
    TimeSteppedParticle& p = time_stepped_particles.emplace_back();
    in.value(p.particle.system);
    in.value(p.particle.particle);
    load_ticks(in, p.ticks);
  }
  if (!in.ok()) contacts.clear(), time_stepped.clear(), time_stepped_particles.clear();
  return in.ok();
}

}  // namespace tumble
