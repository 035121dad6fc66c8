#include "engine/world/world.hpp"

#include "engine/core/hash.hpp"
#include "engine/core/registry.hpp"
#include "engine/core/stop.hpp"
#include "engine/world/courses.hpp"
#include "engine/world/emission.hpp"
#include "engine/world/queries/query_scene.hpp"
#include "engine/world/state.hpp"
#include "engine/world/tick_watch.hpp"

#include <algorithm>

void std::default_delete<tumble::World>::operator()(tumble::World* world) const noexcept {
  delete world;
}

namespace tumble {

World::World(std::unique_ptr<WorldState> state) : state_(std::move(state)) {}
World::~World() = default;

Result<std::unique_ptr<World>> World::create(WorldDef def, std::shared_ptr<ShapeStore> shapes) {
  if (Status s = validate(def.settings); !s) return s.error();
  auto state = std::make_unique<WorldState>();
  state->settings = def.settings;
  state->settings.gravity.go_to(state->time());
  state->log_sink = std::move(def.log);
  state->shapes = shapes ? std::move(shapes) : std::make_shared<ShapeStore>();
  tumble::set_threads(*state, def.threads);
  if (Status s = choose_algorithms(*state, def.settings); !s) return s.error();
  state->log.restart(save_state(*state, true));
  return std::unique_ptr<World>(new World(std::move(state)));
}

namespace {

/// To be called when something other than a tick changes the state.
void note_change(WorldState& s) {
  s.still = false;
  s.frames.due = FrameState::Due::make;
}

/// Applies the queued commands; afterwards the measures are up to date.
Status apply_queue(WorldState& s) {
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

/// A tick after its commands were applied. If `repeatable`, a still state is repeated.
Status advance(WorldState& s, const StepperEntry& stepper, bool repeatable) {
  const CourseSupply supply(s);
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
    supply.book(s);
    ++s.tick;
    s.mark_active();
    const ScopedStage stage(s.profiler, "measure");
    measure(s);
    s.ledger.close(measured(s));
    stepped = check_energy(s);
    if (!stepped) {
      --s.tick;
      s.before.backup.restore(s);
      s.laid_asleep = true;  // bodies created asleep have not looked for contacts yet
    }
  }
  if (!stepped) {
    return_to_now(s);
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
  WorldState& s = *state_;
  if (s.queue.empty()) return {};
  note_change(s);
  if (Status status = apply_queue(s); !status) return status;
  s.particle_detection.clear();  // its contacts may name particles that no longer exist
  return {};
}

// -- time
// -------------------------------------------------------------------------------------------

Result<StepReport> World::step() {
  WorldState& s = *state_;
  if (s.stop && s.stop->requested()) return stopped_error();
  if (s.watch) {  // records of earlier ticks
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
  const WorldState& s = *state_;
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
  const WorldState& s = *state_;
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
