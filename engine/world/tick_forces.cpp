#include "engine/world/tick_forces.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/world/courses.hpp"
#include "engine/world/joint_drives.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// A force at a moment of a tick: as its courses have it then, a copy for this thread, which the
/// next replaces.
const ForceDef& at_moment(const ForceDef& def, double t) {
  if (!follows_courses(def)) return def;
  thread_local ForceDef now;
  now = def;
  go_to(now, t);
  return now;
}

/// Whether a force is attached to a particle that is not a block.
bool holds_particles(const ForceDef& def, const ForceContext& context) {
  const Anchors ends = anchors(def);
  return std::any_of(ends.begin(), ends.end(), [&](const Anchor& a) {
    return a.kind == Anchor::Kind::particle && !pulled_body(a, context);
  });
}

/// Slots of the bodies and blocks that a force is attached to, each once.
std::vector<uint32_t> held_slots(const ForceDef& def, const ForceContext& context) {
  std::vector<uint32_t> out;
  for (const Anchor& a : anchors(def))
    if (const RigidBody* b = pulled_body(a, context))
      out.push_back(uint32_t(b - context.bodies.bodies.data()));
  if (out.size() == 2 && out[0] == out[1]) out.pop_back();
  if (out.size() > 2) {
    std::ranges::sort(out);
    out.erase(std::unique(out.begin(), out.end()), out.end());
  }
  return out;
}

}  // namespace

TickForces::TickForces(WorldState& s, bool drives)
    : state_(s), anchored_(s.bodies.bodies.size()), driven_(s.bodies.bodies.size()) {
  if (drives) assign_drives();
  for (RigidBody& b : s.bodies.bodies) {
    b.force.setZero();
    b.torque.setZero();
  }
  ForceContext context = s.force_context();
  for (uint32_t i = 0; i < s.forces.size(); ++i) {
    if (!s.forces[i]) continue;
    if (holds_particles(*s.forces[i], context)) {
      hold(i);
    } else if (anchors(*s.forces[i]).empty()) {
      fields_.push_back(i);
    } else {
      assign_anchored(i);
    }
  }
  hold_fluids();
  for (const RigidBody& b : s.bodies.bodies) held_.emplace_back(b.force, b.torque);
  if (s.particles.empty()) return;
  for (const uint32_t i : fields_) tumble::apply(*s.forces[i], context);
}

/// Each force with anchors is evaluated once, with the first body that it can move.
void TickForces::assign_anchored(uint32_t force) {
  uint32_t first = ~uint32_t{0};
  for (const uint32_t slot : held_slots(*state_.forces[force], state_.force_context()))
    if (state_.bodies.bodies[slot].dynamic()) first = std::min(first, slot);
  if (first < anchored_.size()) anchored_[first].push_back(force);
}

/// Likewise for the joints with drives.
void TickForces::assign_drives() {
  for (uint32_t i = 0; i < state_.joints.ids.capacity(); ++i) {
    const Joint& joint = state_.joints.joints[i];
    if (!state_.joints.ids.alive(i) || !joint.drives) continue;
    for (const uint32_t slot : {joint.a, joint.b}) {
      if (slot == no_body || !state_.bodies.bodies[slot].dynamic()) continue;
      driven_[slot].push_back(i);
      break;
    }
  }
}

void TickForces::operator()(double t, std::span<const uint32_t> bodies) const {
  WorldState& s = state_;
  charge_work(bodies.size(), 150 * fields_.size() + 20);
  const Vec3 gravity = gravity_at(s, s.time() + t);
  for (const uint32_t slot : bodies) {
    RigidBody& b = s.bodies.bodies[slot];
    b.force = held_[slot].first + (b.mass * b.gravity_scale) * gravity;
    b.torque = held_[slot].second;
  }
  ForceContext context = s.force_context();
  context.momentary = true;
  context.t += t;
  context.only = bodies;
  for (const uint32_t i : fields_) tumble::apply(at_moment(*s.forces[i], context.t), context);
  for (const uint32_t slot : bodies)
    for (const uint32_t i : anchored_[slot]) {
      if (stop_requested()) return;
      charge_work(60);
      tumble::apply(at_moment(*s.forces[i], context.t), context);
    }
  for (const uint32_t slot : bodies)
    for (const uint32_t i : driven_[slot])
      for_drives(s.joints.joints[i], s.bodies.bodies, t, [&](size_t, const ActingDrive& d) {
        push_bodies(d.row, d.force.total(), s.joints.joints[i], s.bodies.bodies);
      });
}

/// A force attached to particles that are not blocks acts by its share, which was computed before.
void TickForces::hold(uint32_t force) {
  WorldState& s = state_;
  if (force >= s.workspace.books.shares.size()) return;
  for (const ForceShare::OnBody& on : s.workspace.books.shares[force].bodies) {
    RigidBody& b = s.bodies.bodies[on.slot];
    if (!b.dynamic()) continue;
    holds_.push_back({force, on.slot, on.force, on.torque, on.held, on.held_torque});
    b.force += on.force;
    b.torque += on.torque;
  }
  for (const ForceShare::OnParticle& on : s.workspace.books.shares[force].particles)
    s.particles[on.system].force[on.index] += on.force;
}

/// The share of fluids follows those of the forces.
void TickForces::hold_fluids() {
  WorldState& s = state_;
  const auto fluids = uint32_t(s.forces.size());
  if (s.workspace.books.shares.size() <= fluids) return;
  for (const ForceShare::OnBody& on : s.workspace.books.shares[fluids].bodies) {
    holds_.push_back({fluids, on.slot, on.force, on.torque, on.held, on.held_torque});
    s.bodies.bodies[on.slot].force += on.force;
    s.bodies.bodies[on.slot].torque += on.torque;
  }
}

/// Share of a force that is not a spring: with the sums zeroed before, the sums are the share.
void TickForces::share_alone(uint32_t force, std::span<const uint32_t> bodies,
                             ForceContext& context, ForceShare& share) const {
  const ForceDef& def = *state_.forces[force];
  const double held = has_potential(def) ? 1 : 0;
  const std::vector<uint32_t> touched = held_slots(def, context);
  const std::span<const uint32_t> acted =
      touched.empty() ? bodies : std::span<const uint32_t>(touched);
  clear_sums(acted);
  tumble::apply(def, context);
  for (const uint32_t slot : acted) {
    const RigidBody& b = state_.bodies.bodies[slot];
    if (b.dynamic())
      share.bodies.push_back({slot, b.force, b.torque, held * b.force, held * b.torque});
  }
}

void TickForces::clear_sums(std::span<const uint32_t> bodies) const {
  for (const uint32_t slot : bodies) {
    state_.bodies.bodies[slot].force.setZero();
    state_.bodies.bodies[slot].torque.setZero();
  }
}

void TickForces::share(std::span<const uint32_t> bodies, std::vector<ForceShare>& out) const {
  WorldState& s = state_;
  ForceContext context = s.force_context();
  context.only = bodies;
  out.assign(s.forces.size() + 1, {});
  SpringsInSlots springs;
  for (const uint32_t cause : causes(bodies)) {
    if (cause == 0) continue;
    const uint32_t force = cause - 1;
    if (force > s.forces.size()) continue;  // forces of joints are up to the solver
    const bool fluids = force == s.forces.size();
    if (fluids || holds_particles(*s.forces[force], context)) {
      for (const Held& h : holds_)
        if (h.force == force && std::ranges::binary_search(bodies, h.slot))
          out[force].bodies.push_back({h.slot, h.push, h.turn, h.elastic_push, h.elastic_turn});
    } else if (!springs.add(*s.forces[force], force)) {
      share_alone(force, bodies, context, out[force]);
    }
  }
  clear_sums(bodies);
  for (const ForceShare& share : out)
    for (const ForceShare::OnBody& on : share.bodies) {
      s.bodies.bodies[on.slot].force += on.force;
      s.bodies.bodies[on.slot].torque += on.torque;
    }
  NetPulls pulls;
  pull_springs(springs.all(), context, {},
               pulls);  // implicit, hence last
  springs.share(pulls, context, out);
}

std::vector<uint32_t> TickForces::causes(std::span<const uint32_t> bodies) const {
  std::vector<uint32_t> out{0};
  for (const uint32_t i : fields_) out.push_back(i + 1);
  for (const uint32_t slot : bodies)
    for (const uint32_t i : anchored_[slot]) out.push_back(i + 1);
  for (const Held& h : holds_)
    if (std::binary_search(bodies.begin(), bodies.end(), h.slot)) out.push_back(h.force + 1);
  for (const uint32_t slot : bodies)
    if (!driven_[slot].empty())
      out.insert(out.end(), {springs_of_joints() + 1, motors_of_joints() + 1});
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// Effect of the springs, or of the motors, of joints.
CauseEffect TickForces::drive_effect(bool motors, double t,
                                     std::span<const uint32_t> bodies) const {
  const std::span<RigidBody> all = state_.bodies.bodies;
  CauseEffect sum;
  for (const uint32_t slot : bodies)
    for (const uint32_t i : driven_[slot]) {
      const Joint& joint = state_.joints.joints[i];
      for_drives(joint, all, t, [&](size_t, const ActingDrive& d) {
        const double force = motors ? d.force.motor : d.force.elastic + d.force.damping;
        for (const auto& [end, side] :
             {std::pair{joint.a, &d.row.row.a}, std::pair{joint.b, &d.row.row.b}}) {
          if (end == no_body || !all[end].dynamic()) continue;
          const Vec3 push = force * side->linear, turn = force * side->angular;
          sum.add({push.dot(all[end].v) + turn.dot(all[end].omega), 0, push,
                   all[end].pose.x.cross(push) + turn});
        }
        // A spring's potential energy is a function of its stretch; only its damper loses energy.
        sum.lost += motors ? force * d.rate : d.force.damping * d.rate;
      });
    }
  return sum;
}

namespace {

CauseEffect effect_on(const RigidBody& b, const Vec3& force, const Vec3& torque) {
  return {force.dot(b.v) + torque.dot(b.omega), 0, force, b.pose.x.cross(force) + torque};
}

/// Power of a spring's damper on the bodies that it can move.
double damping_power(const SpringDef& def, const ForceContext& context) {
  const auto a = locate(def.a, context), b = locate(def.b, context);
  if (!a || !b) return 0;
  const Vec3 d = b->x_world - a->x_world;
  const double length = d.norm();
  if (!(length > 0)) return 0;
  const Vec3 n = d / length;
  const auto moved = [&](const Anchor& end) {
    const RigidBody* body = pulled_body(end, context);
    return body && body->dynamic();
  };
  const double pull = def.damping * n.dot(b->v_world - a->v_world);
  return pull * ((moved(def.a) ? n.dot(a->v_world) : 0) - (moved(def.b) ? n.dot(b->v_world) : 0));
}

/// The same for all dampers of a mesh.
double damping_power(const SpringMeshDef& def, const ForceContext& context) {
  std::vector<MeshNode> nodes;
  locate(*def.mesh, context, nodes);
  std::vector<uint8_t> moved(nodes.size(), 0);
  for (size_t i = 0; i < nodes.size(); ++i) {
    const RigidBody* body = pulled_body(def.mesh->nodes[i], context);
    moved[i] = body && body->dynamic();
  }
  double sum = 0;
  for_pulls(*def.mesh, nodes, [&](uint32_t node, const Vec3&, const Vec3& damped) {
    if (moved[node]) sum += damped.dot(nodes[node].v);
  });
  return sum;
}

/// Of the power `work` of a force, the part that its potential does not account for.
double lost_power(const ForceDef& def, double work, const ForceContext& context) {
  if (const auto* spring = std::get_if<SpringDef>(&def)) return damping_power(*spring, context);
  if (const auto* mesh = std::get_if<SpringMeshDef>(&def)) return damping_power(*mesh, context);
  return has_potential(def) ? 0 : work;
}

}  // namespace

CauseEffect TickForces::effect(uint32_t force, ForceContext& context,
                               std::span<const uint32_t> bodies) const {
  WorldState& s = state_;
  CauseEffect sum;
  const bool fluids = force == s.forces.size();
  if (fluids || holds_particles(*s.forces[force], context)) {
    for (const Held& h : holds_)
      if (h.force == force && std::binary_search(bodies.begin(), bodies.end(), h.slot))
        sum.add(effect_on(s.bodies.bodies[h.slot], h.push, h.turn));
    if (fluids) sum.lost = sum.work;
    return sum;  // the potential accounts for all but the damper
  }
  const ForceDef& def = at_moment(*s.forces[force], context.t);
  const std::vector<uint32_t> touched = held_slots(def, context);
  const std::span<const uint32_t> acted =
      touched.empty() ? bodies : std::span<const uint32_t>(touched);
  for (const uint32_t slot : acted) {
    s.bodies.bodies[slot].force.setZero();
    s.bodies.bodies[slot].torque.setZero();
  }
  tumble::apply(def, context);
  for (const uint32_t slot : acted) {
    const RigidBody& b = s.bodies.bodies[slot];
    if (b.dynamic()) sum.add(effect_on(b, b.force, b.torque));
  }
  sum.lost = lost_power(def, sum.work, context);
  return sum;
}

void TickForces::rates(double t, std::span<const uint32_t> bodies, std::span<const uint32_t> causes,
                       std::span<CauseEffect> out) const {
  WorldState& s = state_;
  ForceContext context = s.force_context();
  context.momentary = true;
  context.t += t;
  context.only = bodies;
  charge_work(causes.size(), 60 * bodies.size() + 60);
  const Vec3 gravity = gravity_at(s, context.t);
  for (size_t i = 0; i < causes.size(); ++i) {
    if (causes[i] > springs_of_joints()) {
      out[i] = drive_effect(causes[i] - 1 == motors_of_joints(), t, bodies);
      continue;
    }
    if (causes[i] > 0) {
      out[i] = effect(causes[i] - 1, context, bodies);
      continue;
    }
    for (const uint32_t slot : bodies) {
      const RigidBody& b = s.bodies.bodies[slot];
      if (!b.dynamic()) continue;
      out[i].add(effect_on(b, (b.mass * b.gravity_scale) * gravity, Vec3::Zero()));
    }
  }
}

}  // namespace tumble
