#include "engine/world/world.hpp"

#include "engine/core/hash.hpp"
#include "engine/core/registry.hpp"
#include "engine/core/stop.hpp"
#include "engine/math/unit_quaternion.hpp"
#include "engine/world/courses.hpp"
#include "engine/world/emission.hpp"
#include "engine/world/queries/query_scene.hpp"
#include "engine/world/state.hpp"
#include "engine/world/tick_watch.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tumble {
namespace {

Error stale(std::string_view kind) {
  return {ErrorCode::not_found, fmt::format("this {} does not exist (any more)", kind), {}, {}};
}

}  // namespace

World::World(std::unique_ptr<State> state) : state_(std::move(state)) {}
World::~World() = default;

Result<std::unique_ptr<World>> World::create(WorldDef def, std::shared_ptr<ShapeStore> shapes) {
  if (Status s = validate(def.settings); !s) return s.error();
  auto state = std::make_unique<State>();
  state->settings = def.settings;
  state->log_sink = std::move(def.log);
  state->shapes = shapes ? std::move(shapes) : std::make_shared<ShapeStore>();
  tumble::set_threads(*state, def.threads);
  if (Status s = choose_algorithms(*state, def.settings); !s) return s.error();
  state->log.restart(save_state(*state, true));
  return std::unique_ptr<World>(new World(std::move(state)));
}

// -- commands
// ---------------------------------------------------------------------------------------

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
Status validate_reserved(const ForceDef& def, World::State& state) {
  BodySet reserved;
  reserved.ids = state.reserved.bodies;
  ForceContext context{reserved, state.reserved.particles, state.particles,
                       state.settings.tick.tick(), state.settings.gravity};
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

/// The newest definition of commands of these kinds that wait in the queue, or null.
template <class Create, class Set, class Id>
const auto* queued_def(const World::State& s, Id id) {
  const decltype(Create::def)* found = nullptr;
  for (const Command& c : s.queue) {
    if (const auto* create = std::get_if<Create>(&c); create && create->id == id)
      found = &create->def;
    if (const auto* set = std::get_if<Set>(&c); set && set->id == id) found = &set->def;
  }
  return found;
}

/// Whether contacts of a system that will exist are looked for.
bool detects(const World::State& s, ParticleSystemId id) {
  if (const auto* def = queued_def<CreateParticles, SetParticles>(s, id))
    return def->detect || def->fast;
  if (!s.particle_ids.contains(id)) return false;
  return s.particles[id.index].detect || s.particles[id.index].fast;
}

/// What an emitter will be, or null.
const EmitterDef* emitter_to_be(const World::State& s, EmitterId id) {
  if (const auto* def = queued_def<CreateEmitter, SetEmitter>(s, id)) return def;
  return s.emitters.ids.contains(id) ? s.emitters.list[id.index].def.get() : nullptr;
}

/// Calls f for all emitters that will exist.
template <class F>
void for_emitters_to_be(const World::State& s, const F& f) {
  for (uint32_t i = 0; i < s.emitters.list.size(); ++i)
    if (s.emitters.ids.alive(i) && s.reserved.emitters.contains(s.emitters.ids.at(i)))
      f(s.emitters.ids.at(i), *emitter_to_be(s, s.emitters.ids.at(i)));
  for (const Command& c : s.queue)
    if (const auto* create = std::get_if<CreateEmitter>(&c);
        create && s.reserved.emitters.contains(create->id))
      f(create->id, *emitter_to_be(s, create->id));
}

/// Emitters whose events are collisions of a system need it to look for them.
Status still_seen(const World::State& s, ParticleSystemId id, const ParticleSystemDef& def) {
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

/// Whether the events of an emitter lead to another one.
bool leads_to(const World::State& s, const EmitterDef& from, EmitterId to) {
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
  State& s = *state_;
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
Status validate_reserved(const EmitterDef& def, World::State& s) {
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
      const EmitterDef* called = emitter_to_be(s, r.emitter);
      if (!called || called->particles.is_null())
        return emitter_error(def, ErrorCode::invalid_argument, "events make particles, not bodies");
    }
    if (r.on == SpawnRule::On::collision && !detects(s, def.particles))
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
  State& s = *state_;
  if (!s.reserved.emitters.contains(id)) return stale("emitter");
  if (Status fine = validate_reserved(def, s); !fine) return fine;
  if (leads_to(s, def, id))
    return emitter_error(def, ErrorCode::invalid_argument,
                         "events lead from it back to it, which would never end");
  bool called = false;
  for_emitters_to_be(s, [&](EmitterId, const EmitterDef& other) {
    for (const SpawnRule& r : other.events) called = called || r.emitter == id;
  });
  if (called && def.particles.is_null())
    return emitter_error(def, ErrorCode::invalid_argument, "events make particles, not bodies");
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

/// Repeats a logged command through the front door, and checks that it gets the same id.
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

namespace {

/// Something else than a tick changes the state.
void note_change(World::State& s) {
  s.still = false;
  s.frames.due = FrameState::Due::make;
}

/// Afterwards the measures are up to date.
Status apply_queue(World::State& s) {
  if (s.queue.empty()) return {};
  std::vector<Command> queue;
  queue.swap(s.queue);
  for (Command& command : queue) {
    if (Status status = apply_command(s, command); !status) return status;
    s.log.add(s.tick, std::move(command));
  }
  measure(s);
  return {};
}

/// The tick after its commands. A still tick may be repeated if `repeatable`.
Status advance(World::State& s, const StepperEntry& stepper, bool repeatable) {
  if (Status done = follow_courses(s); !done) return done;
  s.before.stats = s.stats;
  s.before.ledger = s.ledger;
  s.ledger.open(measured(s), s.forces, s.force_ids);
  s.still = false;
  Status stepped;
  {
    const Stoppable scope(s.stop);
    stepped = stepper.step(s);
  }
  if (stepped) {
    ++s.tick;
    s.mark_active();
    const ScopedStage stage(s.profiler, "measure");
    measure(s);
    s.ledger.close(measured(s));
    stepped = check_energy(s);
    if (!stepped) {
      --s.tick;
      s.before.backup.restore(s);
      s.laid_asleep = true;  // whoever was has not looked around
    }
  }
  if (!stepped) {
    s.stats = s.before.stats;
    s.ledger = s.before.ledger;
    s.islands = {};
    s.still = false;
    s.forget_bodies();
    return stepped;
  }
  sense_tick(s);
  s.still = s.still && repeatable && !sensing_goes_on(s);
  s.stats.stages = s.profiler.stages();
  s.frames.due = FrameState::Due::make;
  return {};
}

}  // namespace

Status World::apply_commands() {
  State& s = *state_;
  if (s.queue.empty()) return {};
  note_change(s);
  if (Status status = apply_queue(s); !status) return status;
  s.particle_detection.clear();  // they may name what is gone
  return {};
}

// -- time
// -------------------------------------------------------------------------------------------

Result<StepReport> World::step() {
  State& s = *state_;
  if (s.stop && s.stop->requested()) return stopped_error();
  if (s.watch) {  // what an earlier tick wrote down is not of this one
    s.watch->searches = {};
    s.watch->pressures = {};
  }
  s.profiler.clear();
  bool commanded = !s.queue.empty();
  if (s.still && !commanded) {
    ++s.tick;
    s.stats.stages.clear();
    const bool news =
        std::ranges::any_of(s.frames.chunks_changed, [](uint8_t c) { return c != 0; });
    if (s.frames.due == FrameState::Due::nothing)
      s.frames.due = news ? FrameState::Due::make : FrameState::Due::repeat;
    return StepReport{s.tick, s.stats};
  }
  {
    const ScopedStage stage(s.profiler, "commands");
    if (commanded) note_change(s);
    if (Status status = apply_queue(s); !status) return status.error();
    const auto emitted = emit_bodies(s);
    if (!emitted) return emitted.error();
    if (*emitted) note_change(s);
    commanded = commanded || *emitted;
  }
  const auto stepper = find_named(all_steppers(), s.settings.stepper, "stepper");
  if (!stepper) return stepper.error();
  Status done;
  const auto all = [&] { done = advance(s, **stepper, !commanded); };
  if ((*stepper)->gathers) {
    s.crew->gather(all);
  } else {
    all();
  }
  if (!done) return done.error();
  return StepReport{s.tick, s.stats};
}

uint64_t World::tick() const {
  return state_->tick;
}
double World::time() const {
  return state_->time();
}
const WorldSettings& World::settings() const {
  return state_->settings;
}
void World::watch_with(TickWatch* watch) {
  state_->watch = watch;
}

void World::stop_with(const StopFlag* flag) {
  state_->stop = flag;
}
void World::set_threads(int threads) {
  tumble::set_threads(*state_, threads);
}

// -- observation
// ------------------------------------------------------------------------------------

std::shared_ptr<const Frame> World::frame() const {
  return present_frame(*state_);
}

uint64_t World::state_hash() const {
  const State& s = *state_;
  ByteWriter out;
  out.value(s.tick);
  for (uint32_t i = 0; i < s.bodies.ids.capacity(); ++i) {
    if (!s.bodies.ids.alive(i)) continue;
    const RigidBody& b = s.bodies.bodies[i];
    out.value(s.bodies.ids.at(i));
    out.value(b.pose.x);
    out.value(b.pose.q.coeffs());
    out.value(b.v);
    out.value(b.omega);
  }
  for (uint32_t i = 0; i < s.particle_ids.capacity(); ++i) {
    if (!s.particle_ids.alive(i)) continue;
    const ParticleSystem& p = s.particles[i];
    out.vector(p.id);
    out.raw(p.x.data(), p.x.size() * sizeof(Vec3));
    out.raw(p.v.data(), p.v.size() * sizeof(Vec3));
    if (p.fluid) out.vector(p.pressure);
    out.raw(p.spin.data(), p.spin.size() * sizeof(Vec3));
  }
  return hash_bytes(out.bytes());
}

std::optional<WorldRayHit> World::ray_cast(const Vec3& origin, const Vec3& direction,
                                           double max_distance) const {
  if (direction.isZero(0)) return std::nullopt;
  const auto hit = queries()->ray({origin, direction, max_distance});
  if (!hit || !*hit) return std::nullopt;
  const RayQueryHit& h = **hit;
  return WorldRayHit{h.target.body, h.target.shape, h.distance, h.x_world, h.normal};
}

std::shared_ptr<const QueryScene> World::queries() const {
  return state_->queries.of(present_frame(*state_), state_->crew.get());
}

const RigidBody* World::body(BodyId id) const {
  return std::as_const(state_->bodies).find(id);
}

std::optional<BodyDef> World::body_def(BodyId id) const {
  const RigidBody* b = body(id);
  if (!b) return std::nullopt;
  BodyDef def = *state_->body_defs[id.index];
  if (!def.course) def.pose = b->body_frame();
  def.velocity = b->v;
  def.angular_velocity = b->omega;
  return def;
}

BodyId World::find_body(std::string_view name) const {
  const State& s = *state_;
  for (uint32_t i = 0; i < s.bodies.ids.capacity(); ++i)
    if (s.bodies.ids.alive(i) && s.body_defs[i]->name == name) return s.bodies.ids.at(i);
  return {};
}

const ForceDef* World::force(ForceId id) const {
  return state_->force_ids.contains(id) ? &*state_->forces[id.index] : nullptr;
}

const JointDef* World::joint(JointId id) const {
  return state_->joints.find(id);
}

JointId World::find_joint(std::string_view name) const {
  const JointStore& joints = state_->joints;
  for (uint32_t i = 0; i < joints.ids.capacity(); ++i)
    if (joints.ids.alive(i) && joints.defs[i].name == name) return joints.ids.at(i);
  return {};
}

const ParticleSystem* World::particles(ParticleSystemId id) const {
  return state_->particle_ids.contains(id) ? &state_->particles[id.index] : nullptr;
}

const Emitter* World::emitter(EmitterId id) const {
  return state_->emitters.ids.contains(id) ? &state_->emitters.list[id.index] : nullptr;
}

const SinkDef* World::sink(SinkId id) const {
  return state_->sinks.ids.contains(id) ? &state_->sinks.list[id.index] : nullptr;
}

const SensorDef* World::sensor(SensorId id) const {
  return state_->sensors.ids.contains(id) ? &state_->sensors.defs[id.index] : nullptr;
}

// -- snapshot and replay
// ------------------------------------------------------------------------------

Bytes World::save(bool with_geometry) const {
  return save_state(*state_, with_geometry);
}

Status World::load(std::span<const std::byte> snapshot) {
  if (auto loaded = load_state(*state_, snapshot); !loaded) return loaded.error();
  state_->log.restart(Bytes(snapshot.begin(), snapshot.end()));
  return {};
}

Status World::rewind(std::span<const std::byte> snapshot) {
  const auto logged = load_state(*state_, snapshot);
  if (!logged) return logged.error();
  state_->log.truncate(size_t(*logged));
  return {};
}

Moment World::moment() const {
  return {save(false), state_->log};
}

Status World::restore(const Moment& moment) {
  if (auto loaded = load_state(*state_, moment.snapshot); !loaded) return loaded.error();
  state_->log = moment.log;
  return {};
}

const ReplayLog& World::replay_log() const {
  return state_->log;
}

}  // namespace tumble
