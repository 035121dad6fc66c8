#include "engine/world/step_realtime.hpp"

#include "engine/core/chunks.hpp"
#include "engine/core/stop.hpp"
#include "engine/dynamics/islands/waking.hpp"
#include "engine/dynamics/realtime/tick.hpp"
#include "engine/world/apart.hpp"
#include "engine/world/break_joints.hpp"
#include "engine/world/break_springs.hpp"
#include "engine/world/courses.hpp"
#include "engine/world/dragged_bodies.hpp"
#include "engine/world/emission.hpp"
#include "engine/world/fast_particles.hpp"
#include "engine/world/fluids.hpp"
#include "engine/world/grains.hpp"
#include "engine/world/tick_common.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Zeroes the force sums of the last tick: those of active bodies, and those of others that forces
/// with anchors acted on.
void clear_forces(WorldState& s) {
  std::vector<RigidBody>& bodies = s.bodies.bodies;
  const auto clear = [&bodies](uint32_t slot) {
    bodies[slot].force.setZero();
    bodies[slot].torque.setZero();
  };
  const bool all = s.roster.everything();
  const std::span<const uint32_t> active = s.roster.active();
  for_chunks(s.crew.get(), all ? bodies.size() : active.size(),
             [&](size_t, size_t first, size_t last) {
               for (size_t k = first; k < last; ++k) clear(all ? uint32_t(k) : active[k]);
             });
  if (all) return;
  for (const ForceShare& share : s.workspace.books.shares)
    for (const ForceShare::OnBody& on : share.bodies)
      if (on.slot < bodies.size()) clear(on.slot);
}

/// By slot: nonzero if contacts or joints held the body in the last tick. Only springs need it.
void find_supported(WorldState& s) {
  s.workspace.supported.clear();
  const bool springs =
      std::ranges::any_of(s.forces, [](const auto& force) { return force && is_spring(*force); });
  if (!springs) return;
  s.workspace.supported.resize(s.bodies.bodies.size(), 0);
  s.contacts.for_each([&s](const Contact& c) {
    if (c.pressed()) s.workspace.supported[c.key.body_a] = s.workspace.supported[c.key.body_b] = 1;
  });
  for (const Joint& joint : s.joints.joints)
    for (const uint32_t slot : {joint.a, joint.b})
      if (slot < s.workspace.supported.size()) s.workspace.supported[slot] = 1;
}

void sum_forces(WorldState& s) {
  clear_forces(s);
  find_supported(s);
  s.workspace.pressed_nets.find(s);
  ForceContext context = s.force_context();
  sum_force_shares(s.forces, context, s.workspace.supported, s.workspace.sums_before,
                   s.workspace.books.shares,
                   [&s](size_t slot) { return s.workspace.pressed_nets.pulls(slot); });
}

/// Appends the colliding particles to the bodies; forces on them then act on their blocks.
Status append_colliding(WorldState& s) {
  const auto which = ParticleBlocks::Which::colliding;
  if (Status made = s.blocks.append(which, s.particle_ids, s.particles, s.bodies.bodies); !made)
    return made;
  for (ForceShare& share : s.workspace.books.shares) share.to_blocks(s.blocks);
  const auto now = std::as_const(s.contacts).contacts();
  const auto of_particles = std::as_const(s.particle_contacts).contacts();
  std::vector<Contact> known(of_particles.begin(), of_particles.end());
  s.blocks.restore_contacts(s.particles, s.touching_particles, known);
  if (known.empty()) return {};
  known.insert(known.end(), now.begin(), now.end());
  std::sort(known.begin(), known.end(),
            [](const Contact& a, const Contact& b) { return a.key < b.key; });
  s.contacts.exchange(std::move(known));
  return {};
}

/// Removes the blocks, and moves their contacts to a set of their own, so that between ticks the
/// main set has contacts of bodies only.
void withdraw_colliding(WorldState& s) {
  s.blocks.give_back(s.bodies.bodies, s.settings.tick.tick(), s.particles);
  if (s.blocks.empty()) {
    s.touching_particles.clear();
    s.particle_contacts.clear();
    return;
  }
  std::vector<Contact> bodies, particles;
  for (const Contact& c : s.contacts.contacts())
    (s.blocks.holds(c.key.body_b) ? particles : bodies).push_back(c);
  s.blocks.store_contacts(particles, s.touching_particles);
  s.contacts.exchange(std::move(bodies));
  s.particle_contacts.assign(std::move(particles));
  s.blocks.remove(s.bodies.bodies);
}

/// Wakes a body at the beginning of a tick for a reason other than contacts.
void rouse(WorldState& s, RigidBody& body) {
  if (body.asleep) s.roster.forget();
  wake(body);
}

void wake_tied_to_particles(WorldState& s, const SpringMesh& mesh) {
  const auto of = [](Anchor::Kind kind) {
    return [kind](const Anchor& a) { return a.kind == kind; };
  };
  if (std::ranges::none_of(mesh.nodes, of(Anchor::Kind::particle))) return;
  for (const Anchor& node : mesh.nodes)
    if (node.kind == Anchor::Kind::body)
      if (RigidBody* b = s.bodies.find(node.body)) rouse(s, *b);
}

/// Wakes bodies that springs connect to particles: particles never sleep.
void wake_tied_to_particles(WorldState& s) {
  for (const auto& force : s.forces) {
    if (const auto* mesh = force ? std::get_if<SpringMeshDef>(&*force) : nullptr)
      wake_tied_to_particles(s, *mesh->mesh);
    const auto* spring = force ? std::get_if<SpringDef>(&*force) : nullptr;
    if (!spring) continue;
    for (const auto& [end, other] : {std::pair{spring->a, spring->b}, {spring->b, spring->a}})
      if (end.kind == Anchor::Kind::body && other.kind == Anchor::Kind::particle)
        if (RigidBody* b = s.bodies.find(end.body)) rouse(s, *b);
  }
}

/// Wakes bodies that rest in fields that change with time.
void wake_in_changing_fields(WorldState& s) {
  const ForceContext context = s.force_context();
  for (const auto& force : s.forces)
    if (force && varies_in_time(*force))
      for_targets(
          *field_targets(*force), context, [&s](RigidBody& b) { rouse(s, b); },
          [](const ParticleSystem&) {});
}

/// Whether the tick moved nothing, and the next one would not either: everything that can move is
/// asleep, and nothing will wake it.
bool moved_nothing(const WorldState& s) {
  if (!s.islands.islands.empty() || emission_to_come(s) || has_courses(s)) return false;
  for (const ParticleSystem& p : s.particles)
    if (p.size() > 0) return false;
  for (const auto& force : s.forces)
    if (force && varies_in_time(*force)) return false;
  const std::span<const uint32_t> active = s.roster.active();
  return std::ranges::none_of(active,
                              [&s](uint32_t slot) { return is_active(s.bodies.bodies[slot]); });
}

/// Lets bodies that were created asleep look for contacts once. Without contacts such a body would
/// wake only a tick after the bodies that carry it have woken, and these may have fallen away from
/// below it by then.
void look_around(WorldState& s) {
  if (!s.laid_asleep) return;
  std::vector<bool> knows(s.bodies.bodies.size(), false);
  s.contacts.for_each(
      [&knows](const Contact& c) { knows[c.key.body_a] = knows[c.key.body_b] = true; });
  for (size_t i = 0; i < s.workspace.proxies.refs.size(); ++i) {
    const uint32_t slot = s.workspace.proxies.refs[i].body;
    if (s.bodies.bodies[slot].asleep && !knows[slot]) s.workspace.proxies.proxies[i].moving = true;
  }
  s.workspace.proxies.news.everything(s.workspace.proxies.proxies);
}

void book_corrections(WorldState& s, LedgerLine line) {
  const ScopedStage stage(s.profiler, "books");
  s.workspace.books.corrected(s.bodies.bodies, line, s.ledger, *s.crew);
}

/// Books between the stages of the bodies, and the stages of other things in between.
class BetweenStages final : public TickListener {
 public:
  explicit BetweenStages(WorldState& state) : s_(state) {}
  void bounds_known() override { look_around(s_); }
  std::span<SolvedSpring> contacts_known(double part) override {
    return s_.workspace.pressed_nets.press(s_, std::as_const(s_.contacts).contacts(), part,
                                           s_.workspace.books.shares);
  }
  void islands_known() override {
    const ScopedStage stage(s_.profiler, "books");
    s_.workspace.books.joints = {
        s_.joints.joints, {}, s_.joints.energies(s_.bodies.bodies).total()};
    s_.workspace.books.begin_part(s_.bodies.bodies, s_.islands.involved, *s_.crew);
  }
  void solved(double part) override {
    s_.workspace.pressed_nets.share(s_, part, s_.workspace.books.shares);
    const ScopedStage stage(s_.profiler, "books");
    s_.workspace.books.joints = {s_.joints.joints, s_.workspace.solver.joint_pushes(),
                                 s_.joints.energies(s_.bodies.bodies).total()};
    s_.workspace.books.end_part(
        {s_.bodies.bodies, s_.contacts, s_.islands, s_.forces, s_.settings.gravity.now(), part},
        s_.ledger, *s_.crew);
  }
  void put_back(const ContinuousStage& stage) override {
    const ScopedStage timed(s_.profiler, "books");
    s_.workspace.books.put_back(s_.bodies.bodies, stage, s_.settings.gravity.now(), s_.ledger,
                                *s_.crew);
  }
  void slept() override { book_corrections(s_, LedgerLine::sleeping); }
  void moved() override {
    {
      const ScopedStage stage(s_.profiler, "books");
      s_.workspace.books.particles(s_.particles, s_.forces, s_.settings.gravity.now(),
                                   s_.settings.tick.tick(), s_.blocks, s_.ledger);
    }
    integrate_particles(s_);
  }

 private:
  WorldState& s_;
};

/// The stages of the bodies, from bounds to sleep.
Status move_bodies(WorldState& s, std::span<const CourseMotion> courses) {
  BetweenStages between(s);
  RealtimeTick tick = realtime_tick(
      s, {s.settings.realtime, body_links(s), s.workspace.apart, s.contacts, between, courses});
  const Status done = tick.run();
  s.stats.bounds_tested = tick.report.bounds_tested;
  s.stats.pairs_found = tick.report.pairs_found;
  s.stats.pairs = tick.report.contacts.pairs;
  s.stats.contacts = tick.report.contacts.contacts;
  s.stats.contact_points = tick.report.contacts.points;
  s.stats.max_penetration = tick.report.contacts.max_penetration;
  s.stats.islands = s.islands.islands.size();
  return outcome_of_stages(s, tick.report, done);
}

Status run_stages(WorldState& s, std::span<const CourseMotion> courses) {
  {
    const ScopedStage stage(s.profiler, "forces");
    wake_tied_to_particles(s);
    wake_in_changing_fields(s);
    sum_forces(s);
    if (stop_requested()) return stopped_error();
    if (const Status moved = move_fluids(s); !moved) return moved;
    carry_on_grains(s);
    if (const Status made = append_colliding(s); !made) return made;
    s.workspace.pressed_nets.tie_blocks(s.bodies.bodies);
    if (stop_requested()) return stopped_error();
    if (!s.blocks.empty()) s.roster.forget();
    if (!s.roster.known()) s.roster.refresh(s.bodies.bodies, s.crew.get());
    if (s.roster.everything()) find_apart(s, s.workspace.apart);
  }
  if (const Status moved = move_bodies(s, courses); !moved) return moved;
  withdraw_colliding(s);
  return check_finite(s);
}

}  // namespace

Status step_realtime(WorldState& state) {
  state.roster.refresh(state.bodies.bodies, state.crew.get());
  TickBackup& backup = state.before.backup;
  backup.take(state);
  begin_joints(state);
  state.event.particles.clear();
  state.event.contacts.clear();  // their stored offsets and forces are out of date
  state.event.time_stepped.clear();
  state.event.time_stepped_particles.clear();
  state.stats.events = state.stats.impacts = state.stats.fallbacks = 0;
  state.stats.time_stepped = 0;
  const std::span<const CourseMotion> courses = course_motions(state);
  Status status = run_stages(state, courses);
  state.blocks.remove(state.bodies.bodies);
  if (status && !stop_requested()) status = step_grains(state, backup);
  if (status && !stop_requested()) status = exchange_fast_impulses(state, backup);
  if (status && !stop_requested()) status = detect_particle_contacts(state, backup);
  if (status && !stop_requested()) status = emit_particles(state, backup);
  status = outcome_of_tick(state, std::move(status));
  if (status) finish_particles(state);
  if (status) break_springs(state);
  if (status) end_tick_on_courses(state, courses);
  if (status) status = end_joints(state);
  if (!status) backup.restore(state);
  if (status) warn_of_dragged_bodies(state);
  // The set of bodies that have looked for contacts, or of blocks, is different in the next tick.
  if (state.laid_asleep || !state.blocks.empty()) state.roster.forget();
  if (status) state.laid_asleep = false;
  state.still = status && moved_nothing(state);
  return status;
}

}  // namespace tumble
