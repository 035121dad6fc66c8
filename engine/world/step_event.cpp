#include "engine/world/step_event.hpp"

#include "engine/core/stop.hpp"
#include "engine/dynamics/event/event_contact_list.hpp"
#include "engine/dynamics/islands/waking.hpp"
#include "engine/world/apart.hpp"
#include "engine/world/break_joints.hpp"
#include "engine/world/break_springs.hpp"
#include "engine/world/courses.hpp"
#include "engine/world/emission.hpp"
#include "engine/world/fast_particles.hpp"
#include "engine/world/fluids.hpp"
#include "engine/world/spring_rates.hpp"
#include "engine/world/tick_common.hpp"
#include "engine/world/tick_forces.hpp"
#include "engine/world/tick_watch.hpp"
#include "engine/world/time_stepping.hpp"
#include "engine/world/tolerances.hpp"

#include <algorithm>
#include <functional>

namespace tumble {
namespace {

/// Bodies do not sleep under this stepper.
void wake_sleepers(WorldState& s) {
  for (RigidBody& b : s.bodies.bodies)
    if (b.asleep) wake(b);
}

LedgerEntry entry_of(const CauseEffect& e) {
  return {e.work, e.lost, e.momentum, e.angular_momentum};
}

/// Books the effects of the causes in the tick: the integrals over the groups' motion, and their
/// impacts.
void book_tick(WorldState& s) {
  static constexpr LedgerLine lines[contact_causes] = {
      LedgerLine::restitution, LedgerLine::friction,   LedgerLine::kinematic, LedgerLine::joints,
      LedgerLine::motors,      LedgerLine::projection, LedgerLine::offset};
  for (const GroupBooks& books : s.event.books) {
    for (size_t i = 0; i < books.causes.size(); ++i) {
      const LedgerEntry e = entry_of(books.forces[i]);
      const uint32_t slot = books.causes[i] - 1;
      if (books.causes[i] == 0)
        s.ledger.book(LedgerLine::gravity, e);
      else if (slot == s.forces.size())
        s.ledger.book(LedgerLine::sph_pressure, e);
      else if (slot > s.forces.size())
        s.ledger.book(slot == s.forces.size() + 1 ? LedgerLine::joints : LedgerLine::motors, e);
      else if (std::holds_alternative<MouseSpringDef>(*s.forces[slot]))
        s.ledger.book(LedgerLine::user, e);
      else
        s.ledger.book_force(slot, e);
    }
    for (size_t i = 0; i < contact_causes; ++i)
      s.ledger.book(lines[i], entry_of(books.contacts[i]));
  }
}

bool any_fast(const WorldState& s) {
  return std::any_of(s.particles.begin(), s.particles.end(),
                     [](const ParticleSystem& p) { return p.fast || p.fluid; });
}

/// Whether a spring is attached to a particle that moves once a tick; such a spring is evaluated
/// once a tick.
bool holds_fast(const WorldState& s, const ForceDef& spring) {
  const Anchors ends = anchors(spring);
  return std::any_of(ends.begin(), ends.end(), [&s](const Anchor& end) {
    return end.kind == Anchor::Kind::particle && s.particle_ids.contains(end.particles) &&
           (s.particles[end.particles.index].fast || s.particles[end.particles.index].fluid);
  });
}

/// Computes the share of each force on particles that are not blocks, for the books.
void share_forces_on_particles(WorldState& s) {
  s.workspace.books.shares.clear();
  if (!any_fast(s)) return;
  for (RigidBody& b : s.bodies.bodies) {
    b.force.setZero();
    b.torque.setZero();
  }
  ForceContext context = s.force_context();
  sum_force_shares(s.forces, context, {}, s.workspace.sums_before, s.workspace.books.shares,
                   [&s](size_t slot) { return holds_fast(s, *s.forces[slot]); });
}

/// Moves the record of time-stepped ticks of particles to the slots of their blocks, while these
/// exist.
void restore_time_stepped(WorldState& s) {
  s.event.time_stepped.resize(s.bodies.bodies.size());
  for (const TimeSteppedParticle& p : s.event.time_stepped_particles)
    if (const uint32_t slot = s.blocks.slot_of(p.particle, s.particles);
        slot != ParticleBlocks::no_slot)
      s.event.time_stepped[slot] = p.ticks;
}

void store_time_stepped(WorldState& s) {
  s.event.time_stepped_particles.clear();
  for (uint32_t slot = 0; slot < s.event.time_stepped.size(); ++slot)
    if (s.blocks.holds(slot) && s.event.time_stepped[slot].last > 0)
      s.event.time_stepped_particles.push_back({s.blocks.name(slot), s.event.time_stepped[slot]});
}

/// Appends the particles that move as bodies do to the bodies.
Status append_particles(WorldState& s) {
  if (Status made = s.blocks.append(ParticleBlocks::Which::not_fast, s.particle_ids, s.particles,
                                    s.bodies.bodies);
      !made)
    return made;
  s.blocks.restore_contacts(s.particles, s.event.particles, s.event.contacts);
  restore_time_stepped(s);
  for (ForceShare& share : s.workspace.books.shares) share.to_blocks(s.blocks);
  return {};
}

void withdraw_particles(WorldState& s) {
  s.blocks.give_back(s.bodies.bodies, s.settings.tick.tick(), s.particles);
  s.blocks.store_contacts(s.event.contacts, s.event.particles);
  store_time_stepped(s);
  s.blocks.remove(s.bodies.bodies);
  s.event.time_stepped.resize(s.bodies.bodies.size());
}

Status move_bodies(WorldState& s, const TickForces& forces, TimeStepping& time_stepping) {
  const ScopedStage stage(s.profiler, "events");
  EventContext context;
  context.settings = s.settings.event;
  context.gravity = greatest_gravity(s);
  context.narrow_phase = s.methods.narrow_phase;
  context.hierarchy = s.methods.hierarchy;
  context.name_of = [&s](uint32_t slot) { return body_label(s, slot); };
  s.methods.broad_phase->use_threads(s.crew.get());
  context.rates = &forces;
  context.joints = s.joints.joints;
  context.couplings = s.joints.couplings;
  context.time_stepping = &time_stepping;
  context.courses = course_motions(s);
  const std::vector<double> rates = spring_rates(s.forces, s.force_context());
  context.spring_rates = rates;
  if (s.watch && s.bodies.find(s.watch->body)) {
    s.watch->searches.body = s.watch->body.index;
    context.search = &s.watch->searches;
  }
  find_apart(s, context.apart);
  return s.event.step(s.bodies.bodies, *s.methods.broad_phase, block_links(s), std::cref(forces),
                      context, s.settings.tick.tick(), *s.crew);
}

/// Converts contacts to the form that frames, queries and the other stepper use.
void publish_contacts(WorldState& s, std::span<const Contact> time_stepped) {
  std::vector<Contact> contacts = contact_list(s.event.contacts, s.bodies.bodies);
  contacts.insert(contacts.end(), time_stepped.begin(), time_stepped.end());
  std::ranges::stable_sort(contacts, {}, &Contact::key);
  s.stats.contacts = contacts.size();
  s.stats.contact_points = 0;
  s.stats.max_penetration = 0;
  for (const Contact& c : contacts) {
    s.stats.contact_points += uint64_t(c.count);
    for (int i = 0; i < c.count; ++i)
      s.stats.max_penetration = std::max(s.stats.max_penetration, -c.points[size_t(i)].gap);
  }
  std::erase_if(contacts, [&s](const Contact& c) { return s.blocks.holds(c.key.body_b); });
  s.contacts.assign(std::move(contacts));
}

void warn_once(const WorldState& s, uint64_t count, bool& told, const std::string& message) {
  if (count == 0 || told) return;
  told = true;
  s.warn(message);
}

void count_work(WorldState& s) {
  const EventStats& done = s.event.stats;
  s.stats.bounds_tested = s.methods.broad_phase->stats().tested;
  s.stats.pairs_found = s.methods.broad_phase->stats().found;
  s.stats.pairs = done.pairs;
  s.stats.events = done.events;
  s.stats.impacts = done.impacts;
  s.stats.fallbacks = done.fallbacks;
  s.stats.time_stepped = done.time_stepped;
  warn_once(s, done.time_stepped, s.told.time_stepped,
            "a tick of bodies cost more than event.budget allows, or no motion from event to "
            "event was found; time-stepping moved them (this is said once; statistics count them)");
  warn_once(s, done.fallbacks, s.told.fallback,
            "the law of impulses '" + s.settings.event.impulses +
                "' found no answer to a collision; it was resolved by 'sequential' (this is said "
                "once; statistics count them)");
  warn_once(s, done.substituted, s.told.substituted,
            "the contact solver '" + s.settings.event.contact_solver +
                "' does not answer for these contacts; another one did (this is said once; "
                "certificates of contacts name it)");
  warn_once(s, done.deepest > tolerances::most_event_depth, s.told.deep,
            "contacts are deeper than 1e-5 m beyond the overlap there was before; use a smaller "
            "tick (this is said once)");
  warn_once(s, done.jams, s.told.jam,
            "slip that no force holds in balance was stopped by an impulse (this is said once)");
}

Status run_event_stages(WorldState& s) {
  wake_sleepers(s);
  std::optional<TickForces> forces;
  std::optional<WorldTimeStepping> time_stepping;
  {
    const ScopedStage stage(s.profiler, "forces");
    share_forces_on_particles(s);
    if (stop_requested()) return stopped_error();
    if (const Status flowed = move_fluids(s); !flowed) return flowed;
    for (ParticleSystem& p : s.particles)
      for (Vec3& f : p.force) f.setZero();
    if (const Status made = append_particles(s); !made) return made;
    forces.emplace(s);
    time_stepping.emplace(s, *forces);
    if (stop_requested()) return stopped_error();
  }
  if (const Status moved = move_bodies(s, *forces, *time_stepping); !moved) return moved;
  if (stop_requested()) return stopped_error();
  book_tick(s);
  count_work(s);
  publish_contacts(s, time_stepping->contacts());
  s.workspace.books.particles(s.particles, s.forces, s.settings.gravity.now(),
                              s.settings.tick.tick(), s.blocks, s.ledger);
  integrate_particles(s);
  for (ParticleSystem& p : s.particles)
    if (p.fluid) std::ranges::fill(p.force, Vec3(Vec3::Zero()));
  withdraw_particles(s);
  {
    const ScopedStage stage(s.profiler, "islands");
    build_islands(s.bodies.bodies, s.contacts, body_links(s), s.settings.tick.tick(), s.islands);
    s.stats.islands = s.islands.islands.size();
  }
  return check_finite(s);
}

}  // namespace

Status step_event(WorldState& state) {
  state.roster.forget();
  TickBackup& backup = state.before.backup;
  backup.take(state);
  begin_joints(state);
  state.particle_contacts.clear();  // their stored impulses are out of date
  state.touching_particles.clear();
  Status status = run_event_stages(state);
  state.blocks.remove(state.bodies.bodies);
  if (status && !stop_requested()) status = exchange_fast_impulses(state, backup);
  if (status && !stop_requested()) status = detect_particle_contacts(state, backup);
  if (status && !stop_requested()) status = emit_particles(state, backup);
  status = outcome_of_tick(state, std::move(status));
  if (status) finish_particles(state);
  if (status) break_springs(state);
  if (status) status = end_joints(state);
  if (!status) backup.restore(state);
  return status;
}

}  // namespace tumble
