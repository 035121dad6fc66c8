// The public functions for commands: each command is checked against what will exist when it is
// applied, and is queued for the next tick.
#include "engine/math/unit_quaternion.hpp"
#include "engine/world/state.hpp"
#include "engine/world/world.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tumble {
namespace {

Error stale(std::string_view kind) {
  return {ErrorCode::not_found, fmt::format("this {} does not exist (any more)", kind), {}, {}};
}

}  // namespace

Result<BodyId> World::create_body(BodyDef def) {
  if (const auto body = make_body(def, state_->shape_factory()); !body) return body.error();
  const BodyId id = state_->reserved.bodies.allocate();
  state_->queue.push_back(CreateBody{id, std::move(def)});
  return id;
}

Status World::set_body(BodyId id, BodyDef def) {
  if (!state_->reserved.bodies.contains(id)) return stale("body");
  if (const auto body = make_body(def, state_->shape_factory()); !body) return body.error();
  state_->queue.push_back(SetBody{id, std::move(def)});
  return {};
}

Status World::destroy_body(BodyId id) {
  if (!state_->reserved.bodies.release(id)) return stale("body");
  state_->reserved.joints.release_at(id);
  state_->queue.push_back(DestroyBody{id});
  return {};
}

Status World::set_pose(BodyId id, const Pose& body_frame) {
  if (!state_->reserved.bodies.contains(id)) return stale("body");
  const double length = body_frame.q.norm();
  if (!body_frame.x.allFinite() || !body_frame.q.coeffs().allFinite() || !(length > 0))
    return Error{ErrorCode::invalid_argument, "pose is not finite", {}, {}};
  state_->queue.push_back(SetPose{id, {body_frame.x, unit(body_frame.q)}});
  return {};
}

Status World::set_velocity(BodyId id, const Vec3& v, const Vec3& omega) {
  if (!state_->reserved.bodies.contains(id)) return stale("body");
  if (!v.allFinite() || !omega.allFinite())
    return Error{ErrorCode::invalid_argument, "velocity is not finite", {}, {}};
  state_->queue.push_back(SetVelocity{id, v, omega});
  return {};
}

Status World::apply_impulse(BodyId id, const Vec3& impulse, const Vec3& x_world) {
  if (!state_->reserved.bodies.contains(id)) return stale("body");
  if (!impulse.allFinite() || !x_world.allFinite())
    return Error{ErrorCode::invalid_argument, "impulse is not finite", {}, {}};
  state_->queue.push_back(ApplyImpulse{id, impulse, x_world});
  return {};
}

namespace {

/// Checks a force against the ids that will exist when its command is applied.
Status validate_reserved(const ForceDef& def, WorldState& state) {
  BodySet reserved;
  reserved.ids = state.reserved.bodies;
  ForceContext context{reserved, state.reserved.particles, state.particles,
                       state.settings.tick.tick(), state.settings.gravity.now()};
  return validate(def, context);
}

}  // namespace

Result<ForceId> World::create_force(ForceDef def) {
  if (Status s = validate_reserved(def, *state_); !s) return s.error();
  const ForceId id = state_->reserved.forces.allocate();
  state_->queue.push_back(CreateForce{id, std::move(def)});
  return id;
}

Status World::set_force(ForceId id, ForceDef def) {
  if (!state_->reserved.forces.contains(id)) return stale("force");
  if (Status s = validate_reserved(def, *state_); !s) return s;
  state_->queue.push_back(SetForce{id, std::move(def)});
  return {};
}

Status World::destroy_force(ForceId id) {
  if (!state_->reserved.forces.release(id)) return stale("force");
  state_->queue.push_back(DestroyForce{id});
  return {};
}

namespace {

/// Checks a joint against the bodies that will exist when its command is applied.
Status validate_reserved(const JointDef& def, const ReservedIds& reserved) {
  if (Status s = validate(def); !s) return s;
  for (const BodyId end : {def.a, def.b})
    if (!end.is_null() && !reserved.bodies.contains(end))
      return Error{
          ErrorCode::not_found, "a body of the joint does not exist (any more)", "joint", {}};
  for (const CoordinateDrive& drive : def.drives) {
    if (!drive.couple || drive.couple->joint.is_null()) continue;
    if (!reserved.joints.contains(drive.couple->joint))
      return Error{ErrorCode::not_found,
                   "the joint that it is coupled to does not exist (any more)",
                   "joint",
                   {}};
    const JointKindEntry& kind = entry_of(reserved.joints.kind(drive.couple->joint));
    if (drive.couple->coordinate >= kind.coordinates.size())
      return Error{ErrorCode::invalid_argument,
                   fmt::format("it is coupled to coordinate {}, but a {} joint has only {}",
                               drive.couple->coordinate, kind.name, kind.coordinates.size()),
                   "joint",
                   {}};
  }
  return {};
}

}  // namespace

Result<JointId> World::create_joint(JointDef def) {
  if (Status s = validate_reserved(def, state_->reserved); !s) return s.error();
  const JointId id = state_->reserved.joints.allocate(def);
  state_->queue.push_back(CreateJoint{id, std::move(def)});
  return id;
}

Status World::set_joint(JointId id, JointDef def) {
  if (!state_->reserved.joints.contains(id)) return stale("joint");
  // A coupling without a joint refers to the joint itself, so the check is of that form.
  for (CoordinateDrive& drive : def.drives)
    if (drive.couple && drive.couple->joint == id) drive.couple->joint = {};
  if (Status s = validate_reserved(def, state_->reserved); !s) return s;
  state_->reserved.joints.change(id, def);
  state_->queue.push_back(SetJoint{id, std::move(def)});
  return {};
}

Status World::destroy_joint(JointId id) {
  if (!state_->reserved.joints.release(id)) return stale("joint");
  state_->queue.push_back(DestroyJoint{id});
  return {};
}

namespace {

/// The newest definition in queued commands of these kinds, or null.
template <class Create, class Set, class Id>
const auto* queued_def(const WorldState& s, Id id) {
  const decltype(Create::def)* found = nullptr;
  for (const Command& c : s.queue) {
    if (const auto* create = std::get_if<Create>(&c); create && create->id == id)
      found = &create->def;
    if (const auto* set = std::get_if<Set>(&c); set && set->id == id) found = &set->def;
  }
  return found;
}

/// Whether contacts of a system's particles will be detected.
bool detects(const WorldState& s, ParticleSystemId id) {
  if (const auto* def = queued_def<CreateParticles, SetParticles>(s, id))
    return def->detect || def->fast;
  if (!s.particle_ids.contains(id)) return false;
  return s.particles[id.index].detect || s.particles[id.index].fast;
}

/// The definition that an emitter will have, or null.
const EmitterDef* emitter_to_be(const WorldState& s, EmitterId id) {
  if (const auto* def = queued_def<CreateEmitter, SetEmitter>(s, id)) return def;
  return s.emitters.ids.contains(id) ? s.emitters.list[id.index].def.get() : nullptr;
}

/// Calls f for all emitters that will exist.
template <class F>
void for_emitters_to_be(const WorldState& s, const F& f) {
  for (uint32_t i = 0; i < s.emitters.list.size(); ++i)
    if (s.emitters.ids.alive(i) && s.reserved.emitters.contains(s.emitters.ids.at(i)))
      f(s.emitters.ids.at(i), *emitter_to_be(s, s.emitters.ids.at(i)));
  for (const Command& c : s.queue)
    if (const auto* create = std::get_if<CreateEmitter>(&c);
        create && s.reserved.emitters.contains(create->id))
      f(create->id, *emitter_to_be(s, create->id));
}

/// Error if emitters have events by collisions of a system whose contacts would no longer be
/// detected.
Status still_seen(const WorldState& s, ParticleSystemId id, const ParticleSystemDef& def) {
  if (def.detect || def.fast) return {};
  Status fine;
  for_emitters_to_be(s, [&](EmitterId, const EmitterDef& e) {
    if (e.particles != id) return;
    for (const SpawnRule& r : e.events)
      if (r.on == SpawnRule::On::collision)
        fine = Error{ErrorCode::invalid_argument,
                     fmt::format("the emitter '{}' waits for collisions of it", e.name),
                     "particle system '" + def.name + "'", "leave its detect, or fast"};
  });
  return fine;
}

/// Whether the events of an emitter lead to another one, directly or not.
bool leads_to(const WorldState& s, const EmitterDef& from, EmitterId to) {
  std::vector<EmitterId> seen;
  const auto see = [&](const EmitterDef& def) {
    for (const SpawnRule& r : def.events)
      if (!r.emitter.is_null() && std::ranges::find(seen, r.emitter) == seen.end())
        seen.push_back(r.emitter);
  };
  see(from);
  for (size_t i = 0; i < seen.size(); ++i) {
    if (seen[i] == to) return true;
    if (const EmitterDef* next = emitter_to_be(s, seen[i])) see(*next);
  }
  return false;
}

}  // namespace

Result<ParticleSystemId> World::create_particles(ParticleSystemDef def) {
  if (Status s = validate(def); !s) return s.error();
  const ParticleSystemId id = state_->reserved.particles.allocate();
  state_->queue.push_back(CreateParticles{id, std::move(def)});
  return id;
}

Status World::destroy_particles(ParticleSystemId id) {
  if (!state_->reserved.particles.release(id)) return stale("particle system");
  state_->queue.push_back(DestroyParticles{id});
  return {};
}

Status World::set_particles(ParticleSystemId id, ParticleSystemDef def, bool keep) {
  WorldState& s = *state_;
  if (!s.reserved.particles.contains(id)) return stale("particle system");
  if (Status fine = validate(def); !fine) return fine;
  if (Status fine = still_seen(s, id, def); !fine) return fine;
  s.queue.push_back(SetParticles{id, std::move(def), keep});
  return {};
}

namespace {

Error emitter_error(const EmitterDef& def, ErrorCode code, std::string message,
                    std::string cure = {}) {
  return {code, std::move(message), "emitter '" + def.name + "'", std::move(cure)};
}

/// Checks an emitter against what will exist when its command is applied.
Status validate_reserved(const EmitterDef& def, WorldState& s) {
  if (Status status = validate(def); !status) return status;
  const auto missing = [&def](const char* what) {
    return emitter_error(def, ErrorCode::not_found,
                         fmt::format("the {} does not exist (any more)", what));
  };
  if (def.body)
    if (const auto body = make_body(*def.body, s.shape_factory()); !body) return body.error();
  if (!def.body && !s.reserved.particles.contains(def.particles)) return missing("particle system");
  if (!def.carrier.is_null() && !s.reserved.bodies.contains(def.carrier)) return missing("carrier");
  for (const SpawnRule& r : def.events) {
    if (!r.emitter.is_null()) {
      if (!s.reserved.emitters.contains(r.emitter)) return missing("emitter of an event");
    }
    if (r.on == SpawnRule::On::collision && !def.body && !detects(s, def.particles))
      return emitter_error(def, ErrorCode::invalid_argument,
                           "collisions of this particle system are not looked for",
                           "set its detect, or fast");
  }
  return {};
}

}  // namespace

Result<EmitterId> World::create_emitter(EmitterDef def) {
  if (Status s = validate_reserved(def, *state_); !s) return s.error();
  const EmitterId id = state_->reserved.emitters.allocate();
  state_->queue.push_back(CreateEmitter{id, std::move(def)});
  return id;
}

Status World::set_emitter(EmitterId id, EmitterDef def) {
  WorldState& s = *state_;
  if (!s.reserved.emitters.contains(id)) return stale("emitter");
  if (Status fine = validate_reserved(def, s); !fine) return fine;
  if (leads_to(s, def, id))
    return emitter_error(def, ErrorCode::invalid_argument,
                         "events lead from it back to it, which would never end");
  s.queue.push_back(SetEmitter{id, std::move(def)});
  return {};
}

Status World::destroy_emitter(EmitterId id) {
  if (!state_->reserved.emitters.release(id)) return stale("emitter");
  state_->queue.push_back(DestroyEmitter{id});
  return {};
}

Result<SinkId> World::create_sink(SinkDef def) {
  if (Status s = validate(def); !s) return s.error();
  for (const ParticleSystemId system : def.systems)
    if (!state_->reserved.particles.contains(system)) return stale("particle system");
  const SinkId id = state_->reserved.sinks.allocate();
  state_->queue.push_back(CreateSink{id, std::move(def)});
  return id;
}

Status World::destroy_sink(SinkId id) {
  if (!state_->reserved.sinks.release(id)) return stale("sink");
  state_->queue.push_back(DestroySink{id});
  return {};
}

Result<SensorId> World::create_sensor(SensorDef def) {
  if (Status s = validate(def); !s) return s.error();
  std::vector<BodyId> named = def.only_bodies;
  for (const BodyId id : {def.carrier, def.a, def.b})
    if (!id.is_null()) named.push_back(id);
  for (const BodyId id : named)
    if (!state_->reserved.bodies.contains(id)) return stale("body");
  for (const ParticleSystemId system : def.only_systems)
    if (!state_->reserved.particles.contains(system)) return stale("particle system");
  const SensorId id = state_->reserved.sensors.allocate();
  state_->queue.push_back(CreateSensor{id, std::move(def)});
  return id;
}

Status World::destroy_sensor(SensorId id) {
  if (!state_->reserved.sensors.release(id)) return stale("sensor");
  state_->queue.push_back(DestroySensor{id});
  return {};
}

Status World::set_settings(const WorldSettings& settings) {
  if (Status s = validate(settings); !s) return s;
  state_->queue.push_back(SetSettings{settings});
  return {};
}

namespace {

/// Queues a logged command by the public functions, and checks that it is given the same id.
struct Resubmit {
  World& world;

  template <class Id>
  Status same(const Result<Id>& made, Id logged) {
    if (!made) return made.error();
    if (*made == logged) return {};
    return Error{
        ErrorCode::invalid_argument, "the command was logged in another world: ids differ", {}, {}};
  }
  Status operator()(const CreateBody& c) { return same(world.create_body(c.def), c.id); }
  Status operator()(const DestroyBody& c) { return world.destroy_body(c.id); }
  Status operator()(const SetPose& c) { return world.set_pose(c.id, c.body_frame); }
  Status operator()(const SetVelocity& c) { return world.set_velocity(c.id, c.v, c.omega); }
  Status operator()(const ApplyImpulse& c) {
    return world.apply_impulse(c.id, c.impulse, c.x_world);
  }
  Status operator()(const CreateForce& c) { return same(world.create_force(c.def), c.id); }
  Status operator()(const SetForce& c) { return world.set_force(c.id, c.def); }
  Status operator()(const DestroyForce& c) { return world.destroy_force(c.id); }
  Status operator()(const CreateParticles& c) { return same(world.create_particles(c.def), c.id); }
  Status operator()(const DestroyParticles& c) { return world.destroy_particles(c.id); }
  Status operator()(const SetSettings& c) { return world.set_settings(c.settings); }
  Status operator()(const CreateJoint& c) { return same(world.create_joint(c.def), c.id); }
  Status operator()(const SetJoint& c) { return world.set_joint(c.id, c.def); }
  Status operator()(const DestroyJoint& c) { return world.destroy_joint(c.id); }
  Status operator()(const CreateEmitter& c) { return same(world.create_emitter(c.def), c.id); }
  Status operator()(const DestroyEmitter& c) { return world.destroy_emitter(c.id); }
  Status operator()(const CreateSink& c) { return same(world.create_sink(c.def), c.id); }
  Status operator()(const DestroySink& c) { return world.destroy_sink(c.id); }
  Status operator()(const SetBody& c) { return world.set_body(c.id, c.def); }
  Status operator()(const CreateSensor& c) { return same(world.create_sensor(c.def), c.id); }
  Status operator()(const DestroySensor& c) { return world.destroy_sensor(c.id); }
  Status operator()(const SetParticles& c) { return world.set_particles(c.id, c.def, c.keep); }
  Status operator()(const SetEmitter& c) { return world.set_emitter(c.id, c.def); }
};

}  // namespace

Status World::submit(Command command) {
  return std::visit(Resubmit{*this}, command);
}

}  // namespace tumble
