#pragma once
#include "engine/collision/broad_phase.hpp"
#include "engine/core/crew.hpp"
#include "engine/core/log.hpp"
#include "engine/core/profiler.hpp"
#include "engine/core/result.hpp"
#include "engine/core/stop.hpp"
#include "engine/dynamics/bodies/roster.hpp"
#include "engine/dynamics/contact/contact_set.hpp"
#include "engine/dynamics/event/event_stepper.hpp"
#include "engine/dynamics/grains/grain_stage.hpp"
#include "engine/dynamics/islands/islands.hpp"
#include "engine/dynamics/particles/particle_blocks.hpp"
#include "engine/dynamics/realtime/continuous.hpp"
#include "engine/dynamics/realtime/realtime_solver.hpp"
#include "engine/dynamics/realtime/sleeping.hpp"
#include "engine/world/command.hpp"
#include "engine/world/emission_scratch.hpp"
#include "engine/world/fluid_workspace.hpp"
#include "engine/world/frame.hpp"
#include "engine/world/frame_pool.hpp"
#include "engine/world/joint_store.hpp"
#include "engine/world/ledger/realtime_books.hpp"
#include "engine/world/particle_detection.hpp"
#include "engine/world/pressed_nets.hpp"
#include "engine/world/queries/query_cache.hpp"
#include "engine/world/sensors/sense.hpp"
#include "engine/world/settings.hpp"
#include "engine/world/shape_store.hpp"
#include "engine/world/tick_backup.hpp"

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace tumble {

struct TickWatch;

/// A live force and its definition; dead slots are empty.
using ForceSlots = std::vector<std::optional<ForceDef>>;

/// Identity of everything that commands name, including commands that still wait in the queue: an
/// id is given out when the command is queued, and the same allocation is repeated when it is
/// applied.
struct ReservedIds {
  HandlePool<BodyTag> bodies;
  HandlePool<ForceTag> forces;
  HandlePool<ParticleSystemTag> particles;
  ReservedJoints joints;
  HandlePool<EmitterTag> emitters;
  HandlePool<SinkTag> sinks;
  HandlePool<SensorTag> sensors;
};

/// Emitters by slot; a dead one has no definition.
struct EmitterSet {
  HandlePool<EmitterTag> ids;
  std::vector<Emitter> list;

  Emitter* find(EmitterId id) { return ids.contains(id) ? &list[id.index] : nullptr; }
};

struct SinkSet {
  HandlePool<SinkTag> ids;
  std::vector<SinkDef> list;  ///< by slot
};

/// A collision of a `fast` particle in this tick.
struct FastCollision {
  uint32_t system = 0, particle = 0;  ///< slot and index
  Vec3 x = Vec3::Zero();              ///< of its centre [m]
};

/// What bodies add to the measures.
struct BodySums {
  uint64_t awake = 0;
  double kinetic = 0, gravity = 0;  ///< energies [J]
  Vec3 momentum = Vec3::Zero(), angular_momentum = Vec3::Zero();

  void add(const RigidBody& body, const Vec3& g);
  void add(const BodySums& other);
};

/// Where the present tick rate began to count: time is seconds + (n - tick) / rate.
struct Clock {
  uint64_t tick = 0;
  double seconds = 0;
};

/// The algorithms that the settings name.
struct Methods {
  std::unique_ptr<BroadPhase> broad_phase;
  std::unique_ptr<BroadPhase> path_broad_phase;  ///< of the continuous stage, whose bounds differ
  NarrowPhase narrow_phase = &collide;
  ContinuousMethods continuous;
  const HierarchyKind* hierarchy = nullptr;  ///< of mesh against mesh; null for "aabb"
};

/// Memory that the stages of a tick use again in the next one.
struct Workspace {
  RealtimeSolver solver;
  ContinuousStage continuous;
  ProxySet proxies;
  std::vector<ProxyPair> pairs;
  RealtimeBooks books;
  PairFilter apart;             ///< of the present tick
  std::vector<BodyLink> links;  ///< of body_links()
  SumsBefore sums_before;
  std::vector<uint8_t> supported;  ///< by slot, for springs: see pull_springs()
  PressedNets pressed_nets;
  SleepScratch sleep_scratch;
  std::vector<FastCollision> fast_collisions;  ///< of the present tick, in the order of their time
  EmissionScratch emission;
  FluidWorkspace fluids;
  GrainStage grains;
  GrainReport grain_report;  ///< of the present tick
  SensorScratch sensors;
};

/// What was there before the present tick: a tick that fails puts it back.
struct BeforeTick {
  TickBackup backup;
  StepStats stats;
  Ledger ledger;
};

/// The last frame, and what the next one need not make anew.
struct FrameState {
  std::shared_ptr<const Frame> last;  ///< that was asked for
  /// What is to be done when the next is asked for, by any thread while none steps.
  enum class Due : uint8_t { nothing, repeat, make };
  Due due = Due::make;
  std::mutex mutex;
  FramePool pool;
  bool infos_changed = true;  ///< bodies or joints were made or destroyed since the last frame
  std::vector<uint8_t> chunks_changed;   ///< by chunk, since the last frame
  bool unsure = true;                    ///< chunks_changed may lack some: all bodies are looked at
  uint64_t resting_revision = 0;         ///< of the last frame's resting contacts
  std::vector<const Contact*> contacts;  ///< scratch

  void mark_changed(uint32_t body_slot);
  void forget_bodies();
};

/// What bodies add to the measures, by block of slots.
struct BlockSums {
  std::vector<BodySums> blocks;
  std::vector<uint32_t> stale;  ///< those that were summed anew
};

/// What has been said once in a world's life and is only counted from then on.
struct Told {
  bool fallback = false, substituted = false, jam = false, deep = false, dragged = false,
       time_stepped = false, two_fluids = false;
};

/// All that a World is. The first group is saved in snapshots; the rest is derived or scratch.
struct WorldState {
  // -- saved
  WorldSettings settings;
  uint64_t tick = 0;
  Clock clock;
  BodySet bodies;
  std::vector<std::shared_ptr<const BodyDef>> body_defs;  ///< by body slot, null when dead
  HandlePool<ForceTag> force_ids;
  ForceSlots forces;
  JointStore joints;
  HandlePool<ParticleSystemTag> particle_ids;
  std::vector<ParticleSystem> particles;  ///< by slot
  ContactSet contacts;
  ContactSet particle_contacts;  ///< under realtime; they name particles by their place in
  std::vector<ParticleName> touching_particles;
  GrainTouches grain_touches;
  EmitterSet emitters;
  SinkSet sinks;
  SensorSet sensors;
  EventStepper event;  ///< its contacts and the particles that they name
  Ledger ledger;
  ReservedIds reserved;
  std::vector<Command> queue;

  // -- the world's surroundings
  ReplayLog log;
  LogSink log_sink;
  Told told;
  std::shared_ptr<ShapeStore> shapes;
  std::unique_ptr<Crew> crew;
  const StopFlag* stop = nullptr;  ///< of the caller
  TickWatch* watch = nullptr;      ///< likewise; null: nobody looks

  // -- derived by each tick, or scratch
  std::vector<uint32_t> on_course;  ///< slots of bodies whose definition has a course, ascending
  std::vector<uint32_t> forces_on_course;  ///< slots of forces that follow any, ascending
  Methods methods;
  Workspace workspace;
  Roster roster;
  ParticleBlocks blocks;  ///< behind the bodies, while a tick lasts
  IslandSet islands;
  ParticleDetection particle_detection;
  StepStats stats;
  BlockSums sums;
  BeforeTick before;
  Profiler profiler;
  FrameState frames;
  QueryCache queries;
  /// The last tick left everything as it was, and so will every later one until something else than
  /// a tick changes the state: frames are repeated.
  bool still = false;
  /// Some bodies may have been made asleep since the last tick: they have no contacts yet.
  bool laid_asleep = true;

  /// What a ShapeFactory refers to.
  auto shape_factory() {
    return [this](const ShapeDef& def) { return shapes->shape(def); };
  }
  double time() const { return clock.seconds + settings.tick.time(tick - clock.tick); }
  /// Of the end of the tick under way [s].
  double time_after() const { return clock.seconds + settings.tick.time(tick + 1 - clock.tick); }
  ForceContext force_context();
  /// For the next frame: the bodies that the tick may have changed.
  void mark_active();
  /// From here on any body may be another than the last tick left.
  void forget_bodies();
  void warn(std::string_view message) const {
    if (log_sink) log_sink(LogLevel::warning, message);
  }
};

/// Gives the world its own threads; 0: one thread per core.
void set_threads(WorldState& state, int threads);

/// Carries out one validated command.
Status apply_command(WorldState& state, const Command& command);

/// Makes the algorithm objects that the settings name.
Status choose_algorithms(WorldState& state, const WorldSettings& settings);
Status validate(const WorldSettings& settings);

/// The frame of the present state, which is made now unless it was before.
const std::shared_ptr<const Frame>& present_frame(WorldState& state);

/// Energies, momenta and counts of the present state.
void measure(WorldState& state);
/// After the books of a tick: an error where energy or momentum is not finite, or where there is a
/// thousand times as much energy as came in by anything that the books know; names what has most.
Status check_energy(const WorldState& state);
/// What the books compare, as measured last.
LedgerState measured(const WorldState& state);
/// The same of some particles alone: `systems` by slot.
LedgerState measure_particles(WorldState& state, std::vector<ParticleSystem>& systems);

/// A way to compute a tick.
struct StepperEntry {
  std::string_view name;
  Status (*step)(WorldState& state);
  bool gathers = false;  ///< its loops are short: the threads stay together for the whole tick
};
/// "event", "realtime".
const std::vector<StepperEntry>& all_steppers();

Bytes save_state(const WorldState& state, bool with_geometry);
/// Replaces the state or leaves it alone; gives the length of the replay log when it was saved.
Result<uint64_t> load_state(WorldState& state, std::span<const std::byte> snapshot);

}  // namespace tumble
