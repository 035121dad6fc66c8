#include "engine/dynamics/islands/waking.hpp"
#include "engine/world/courses.hpp"
#include "engine/world/emission.hpp"
#include "engine/world/state.hpp"

#include <fmt/format.h>

namespace tumble {
namespace {

bool alike(const Pose& a, const Pose& b) {
  return a.x == b.x && a.q.coeffs() == b.q.coeffs();
}

struct Apply {
  WorldState& s;

  /// Wakes a body that the command changes in nothing but what it sets, so that the rest of the
  /// world may stay asleep.
  void rouse(BodyId id) {
    RigidBody* b = s.bodies.find(id);
    if (!b) return;
    wake(*b);
    s.roster.touch(id.index);
    s.frames.mark_changed(id.index);
  }

  /// Updates the coordinates of a body's joints, which count full turns from the stored values and
  /// rates.
  void tell_joints(BodyId id) {
    for (const JointId joint : s.joints.at_body(id))
      follow_coordinates(s.joints.joints[joint.index], s.bodies.bodies, 0);
  }

  Status broken() const {
    return Error{
        ErrorCode::internal, "a queued command names something that does not exist", {}, {}};
  }

  /// make_body() has laid a body asleep where its definition says so.
  void note_asleep(const RigidBody& body) { s.laid_asleep = s.laid_asleep || body.asleep; }

  Status operator()(const CreateBody& c) {
    auto body = make_body(c.def, s.shape_factory());
    if (!body) return body.error();
    const BodyId id = s.bodies.ids.allocate();
    if (id != c.id) return broken();
    if (s.bodies.bodies.size() <= id.index) {
      s.bodies.bodies.resize(id.index + 1);
      s.body_defs.resize(id.index + 1);
    }
    note_asleep(*body);
    body->teleported = true;
    s.bodies.bodies[id.index] = std::move(*body);
    s.body_defs[id.index] = std::make_shared<const BodyDef>(c.def);
    begin_course(s, id.index);
    s.frames.mark_changed(id.index);
    s.frames.infos_changed = true;
    return {};
  }

  /// Drops the stored contacts of a body, and wakes what touches it.
  void forget_contacts(BodyId id) {
    wake_touching(s.bodies.bodies, s.contacts, id.index);
    wake_grains_on(s.grain_touches, id.index, s.particles);
    s.contacts.remove_body(id.index);
    s.particle_contacts.remove_body(id.index);
    s.event.remove_body(id.index);
  }

  Status operator()(const SetBody& c) {
    RigidBody* old = s.bodies.find(c.id);
    if (!old) return broken();
    BodyDef def = c.def;
    const BodyDef& known = *s.body_defs[c.id.index];
    const Pose before = old->body_frame();
    const bool same_course = def.course == known.course;
    // What has woken it since it was made, as forces do, has woken the changed one too.
    const bool may_sleep = s.tick == 0 && (old->asleep || !known.starts_asleep);
    // World::body_def() gives the pose at which a course begins: the body is where that has led,
    // and stays there or as it has turned in what was not changed.
    if (def.course && same_course) {
      if (def.pose.x == known.pose.x) def.pose.x = before.x;
      if (def.pose.q.coeffs() == known.pose.q.coeffs()) def.pose.q = before.q;
    }
    auto body = make_body(def, s.shape_factory());
    if (!body) return body.error();
    forget_contacts(c.id);
    body->teleported = !alike(before, body->body_frame());
    if (same_course && !body->teleported && body->v == old->v && body->omega == old->omega) {
      def.pose = known.pose;  // the pose at which its course begins, not its present pose
    } else {
      if (same_course) def.course = nullptr;
      end_course(s, c.id.index);
    }
    *old = std::move(*body);
    s.body_defs[c.id.index] = std::make_shared<const BodyDef>(std::move(def));
    if (!same_course) begin_course(s, c.id.index);
    // Before the first tick a body begins as one that is created; later it has begun already, and
    // what is changed is awake.
    old->asleep = old->asleep && may_sleep;
    note_asleep(*old);
    for (const JointId joint : s.joints.at_body(c.id)) {
      const JointDef def = s.joints.defs[joint.index];
      wake_ends(def);
      wake_coupled(joint);
      s.joints.put(joint, def, s.bodies);
    }
    s.frames.mark_changed(c.id.index);
    s.frames.infos_changed = true;
    return {};
  }

  Status operator()(const DestroyBody& c) {
    if (!s.bodies.ids.contains(c.id)) return broken();
    forget_contacts(c.id);
    for (const JointId joint : s.joints.at_body(c.id)) {
      wake_ends(s.joints.defs[joint.index]);
      wake_coupled(joint);
      s.joints.release(joint);
    }
    for (uint32_t i = 0; i < s.forces.size(); ++i)
      if (s.forces[i]) release_anchors(*s.forces[i], c.id);
    s.bodies.ids.release(c.id);
    s.bodies.bodies[c.id.index] = RigidBody{};
    s.bodies.bodies[c.id.index].type = BodyType::fixed;
    s.body_defs[c.id.index] = nullptr;
    end_course(s, c.id.index);
    s.frames.mark_changed(c.id.index);
    s.frames.infos_changed = true;
    return {};
  }

  /// A spring that loses one end wakes the body at the other; it stays, without effect.
  void release_anchors(const ForceDef& def, BodyId gone) {
    bool touched = false;
    for (const Anchor& a : anchors(def)) touched |= a.kind == Anchor::Kind::body && a.body == gone;
    if (!touched) return;
    for (const Anchor& a : anchors(def))
      if (RigidBody* b = a.kind == Anchor::Kind::body ? s.bodies.find(a.body) : nullptr) wake(*b);
  }

  Status operator()(const SetPose& c) {
    RigidBody* b = s.bodies.find(c.id);
    if (!b) return broken();
    wake_touching(s.bodies.bodies, s.contacts, c.id.index);
    wake_grains_on(s.grain_touches, c.id.index, s.particles);
    for (const JointId joint : s.joints.at_body(c.id)) wake_ends(s.joints.defs[joint.index]);
    end_course(s, c.id.index);
    b->pose.q = c.body_frame.q;
    b->pose.x = c.body_frame.point(b->centre_body);
    s.event.remove_body(c.id.index);  // overlap at the new pose counts as initial
    tell_joints(c.id);
    b->teleported = true;
    wake(*b);
    s.frames.mark_changed(c.id.index);
    return {};
  }

  Status operator()(const SetVelocity& c) {
    RigidBody* b = s.bodies.find(c.id);
    if (!b) return broken();
    end_course(s, c.id.index);
    b->v = c.v;
    b->omega = c.omega;
    tell_joints(c.id);
    rouse(c.id);
    if (!b->dynamic())
      s.forget_bodies();  // it has no island, and begins or ceases to look for contacts
    return {};
  }

  Status operator()(const ApplyImpulse& c) {
    RigidBody* b = s.bodies.find(c.id);
    if (!b) return broken();
    if (!b->dynamic()) return {};
    const double before = b->kinetic_energy();
    b->v += b->inverse_mass * c.impulse;
    b->omega += b->inverse_inertia_world() * (c.x_world - b->pose.x).cross(c.impulse);
    const double work = b->kinetic_energy() - before;
    s.ledger.book_between(LedgerLine::user, {work, work, c.impulse, c.x_world.cross(c.impulse)});
    tell_joints(c.id);
    rouse(c.id);
    return {};
  }

  /// Whether a force without anchors may set a resting body in motion; drag without wind does not.
  static bool moves_resting(const ForceDef& def) {
    if (std::holds_alternative<LinearDragDef>(def)) return false;
    if (const auto* drag = std::get_if<QuadraticDragDef>(&def))
      return drag->wind.varies() || !drag->wind.now().isZero(0);
    return anchors(def).empty();
  }
  void wake_anchors(const ForceDef& def) {
    for (const Anchor& a : anchors(def))
      if (a.kind == Anchor::Kind::body) rouse(a.body);
    const FieldTargets* targets = field_targets(def);
    if (targets && !targets->everything()) {
      for (const BodyId id : targets->bodies) rouse(id);
    } else if (moves_resting(def)) {
      wake_all(s.bodies.bodies);
      for (ParticleSystem& p : s.particles) p.wake_grains();
      s.forget_bodies();
    }
  }

  Status operator()(const CreateForce& c) {
    const ForceId id = s.force_ids.allocate();
    if (id != c.id) return broken();
    if (s.forces.size() <= id.index) s.forces.resize(id.index + 1);
    s.forces[id.index] = c.def;
    begin_force(s, id.index);
    wake_anchors(c.def);
    return {};
  }

  Status operator()(const SetForce& c) {
    if (!s.force_ids.contains(c.id)) return broken();
    wake_anchors(*s.forces[c.id.index]);
    s.forces[c.id.index] = c.def;
    begin_force(s, c.id.index);
    wake_anchors(c.def);
    return {};
  }

  Status operator()(const DestroyForce& c) {
    if (!s.force_ids.contains(c.id)) return broken();
    wake_anchors(*s.forces[c.id.index]);
    s.force_ids.release(c.id);
    s.forces[c.id.index].reset();
    begin_force(s, c.id.index);
    return {};
  }

  void wake_ends(const JointDef& def) {
    for (const BodyId end : {def.a, def.b})
      if (RigidBody* b = s.bodies.find(end)) wake(*b);
  }

  /// Wakes the bodies of the joints that are coupled with a joint that changes.
  void wake_coupled(JointId id) {
    for (const JointCoupling& c : s.joints.couplings)
      if (c.a == id.index || c.b == id.index)
        for_bodies(c, s.joints.joints, [this](uint32_t slot) { wake(s.bodies.bodies[slot]); });
  }

  Status operator()(const CreateJoint& c) {
    const JointId id = s.joints.ids.allocate();
    if (id != c.id) return broken();
    s.joints.put(id, c.def, s.bodies);
    s.frames.infos_changed = true;
    wake_ends(c.def);
    return {};
  }

  Status operator()(const SetJoint& c) {
    const JointDef* old = s.joints.find(c.id);
    if (!old) return broken();
    wake_ends(*old);
    wake_coupled(c.id);
    s.joints.put(c.id, c.def, s.bodies);
    wake_coupled(c.id);
    s.frames.infos_changed = true;
    wake_ends(c.def);
    return {};
  }

  Status operator()(const DestroyJoint& c) {
    const JointDef* old = s.joints.find(c.id);
    if (!old) return broken();
    wake_ends(*old);
    wake_coupled(c.id);
    s.joints.release(c.id);
    s.frames.infos_changed = true;
    return {};
  }

  Status operator()(const CreateParticles& c) {
    const ParticleSystemId id = s.particle_ids.allocate();
    if (id != c.id) return broken();
    if (s.particles.size() <= id.index) s.particles.resize(id.index + 1);
    s.particles[id.index] = make_particle_system(c.def);
    return {};
  }

  Status operator()(const DestroyParticles& c) {
    if (!s.particle_ids.release(c.id)) return broken();
    s.particles[c.id.index] = {};
    return {};
  }

  /// Drops what is stored about the particles of a system that begins anew: their ids count from 1
  /// again, and 0 is no particle's id.
  void forget_particles(ParticleSystemId id) {
    const ParticleSystem& old = s.particles[id.index];
    for (const EmitterId from : old.emitter)
      if (Emitter* e = s.emitters.find(from); e && e->alive > 0) --e->alive;
    for (auto* names : {&s.touching_particles, &s.event.particles})
      for (ParticleName& name : *names)
        if (name.system == id) name.particle = 0;
    std::erase_if(s.event.time_stepped_particles,
                  [&](const TimeSteppedParticle& p) { return p.particle.system == id; });
    const std::vector<uint32_t> gone(old.size(), ParticleDetection::gone);
    s.particle_detection.renumber(id, gone);
    s.grain_touches.clear();
  }

  Status operator()(const SetParticles& c) {
    if (!s.particle_ids.contains(c.id)) return broken();
    ParticleSystem& system = s.particles[c.id.index];
    if (c.keep) {
      take_values(system, c.def);
      note_quantity(system);
    } else {
      forget_particles(c.id);
      system = make_particle_system(c.def);
    }
    reserve_for_emitters(s);
    wake_all(s.bodies.bodies);
    for (ParticleSystem& p : s.particles) p.wake_grains();
    return {};
  }

  Status operator()(const CreateEmitter& c) {
    const EmitterId id = s.emitters.ids.allocate();
    if (id != c.id) return broken();
    if (s.emitters.list.size() <= id.index) s.emitters.list.resize(id.index + 1);
    auto made = make_emitter(c.def, s.time());
    if (!made) return made.error();
    s.emitters.list[id.index] = std::move(*made);
    reserve_for_emitters(s);
    return {};
  }

  Status operator()(const SetEmitter& c) {
    Emitter* old = s.emitters.find(c.id);
    if (!old) return broken();
    auto next = make_emitter(c.def, old->begun);
    if (!next) return next.error();
    old->def = std::move(next->def);
    old->shape = std::move(next->shape);
    reserve_for_emitters(s);
    return {};
  }

  Status operator()(const DestroyEmitter& c) {
    if (!s.emitters.ids.release(c.id)) return broken();
    s.emitters.list[c.id.index] = {};
    return {};
  }

  Status operator()(const CreateSink& c) {
    const SinkId id = s.sinks.ids.allocate();
    if (id != c.id) return broken();
    if (s.sinks.list.size() <= id.index) s.sinks.list.resize(id.index + 1);
    s.sinks.list[id.index] = c.def;
    return {};
  }

  Status operator()(const DestroySink& c) {
    if (!s.sinks.ids.release(c.id)) return broken();
    s.sinks.list[c.id.index] = {};
    return {};
  }

  Status operator()(const CreateSensor& c) {
    const SensorId id = s.sensors.ids.allocate();
    if (id != c.id) return broken();
    if (s.sensors.defs.size() <= id.index) {
      s.sensors.defs.resize(id.index + 1);
      s.sensors.states.resize(id.index + 1);
    }
    s.sensors.defs[id.index] = c.def;
    s.sensors.states[id.index] = {};
    s.sensors.states[id.index].begun = s.time();
    return {};
  }

  Status operator()(const DestroySensor& c) {
    if (!s.sensors.ids.release(c.id)) return broken();
    s.sensors.defs[c.id.index] = {};
    s.sensors.states[c.id.index] = {};
    return {};
  }

  /// Whether bodies that rest under the old settings may not rest under the new ones.
  static bool disturbs_rest(const WorldSettings& old, const WorldSettings& now) {
    return now.gravity.now() != old.gravity.now() || now.tick != old.tick ||
           now.stepper != old.stepper || now.realtime.sleeping != old.realtime.sleeping ||
           now.realtime.sleep_speed < old.realtime.sleep_speed;
  }

  Status operator()(const SetSettings& c) {
    if (Status status = choose_algorithms(s, c.settings); !status) return status;
    WorldSettings wanted = c.settings;
    wanted.gravity.go_to(s.time());
    if (!wanted.gravity.now().allFinite())
      return Error{ErrorCode::invalid_argument,
                   fmt::format("gravity has no finite value at {} s", s.time()), "settings.gravity",
                   "give an expression that has one at every time"};
    if (disturbs_rest(s.settings, wanted)) {
      wake_all(s.bodies.bodies);
      for (ParticleSystem& p : s.particles) p.wake_grains();
    }
    if (wanted.tick != s.settings.tick) {
      s.clock = {s.tick, s.time()};
    }
    s.settings = std::move(wanted);
    return {};
  }
};

}  // namespace

/// Whether a command marks the bodies that it changes by itself.
bool names_bodies(const Command& command) {
  return std::holds_alternative<SetVelocity>(command) ||
         std::holds_alternative<ApplyImpulse>(command) ||
         std::holds_alternative<CreateForce>(command) ||
         std::holds_alternative<SetForce>(command) ||
         std::holds_alternative<DestroyForce>(command) ||
         std::holds_alternative<CreateSensor>(command) ||
         std::holds_alternative<DestroySensor>(command);
}

Status apply_command(WorldState& state, const Command& command) {
  if (!names_bodies(command)) state.forget_bodies();
  return std::visit(Apply{state}, command);
}

}  // namespace tumble
