#pragma once
#include "engine/collision/broad_phase.hpp"
#include "engine/core/crew.hpp"
#include "engine/core/log.hpp"
#include "engine/core/profiler.hpp"
#include "engine/core/result.hpp"
#include "engine/core/stop.hpp"
#include "engine/dynamics/bodies/course_motion.hpp"
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
#include "engine/world/kept_drives.hpp"
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

/// Definitions of the live forces, by slot; dead slots are empty.
using ForceSlots = std::vector<std::optional<ForceDef>>;

/// Ids of everything that commands name, including those of queued commands: an id is given out
/// when its command is queued, and the same allocation is repeated when it is applied.
struct ReservedIds {
  HandlePool<BodyTag> bodies;
  HandlePool<ForceTag> forces;
  HandlePool<ParticleSystemTag> particles;
  ReservedJoints joints;
  HandlePool<EmitterTag> emitters;
  HandlePool<SinkTag> sinks;
  HandlePool<SensorTag> sensors;
};

/// Emitters by slot; dead ones have no definition.
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
  Vec3 x = Vec3::Zero();              ///< centre of the particle [m]
};

/// Contributions of bodies to the measured sums.
struct BodySums {
  uint64_t awake = 0;
  double kinetic = 0, gravity = 0;  ///< energies [J]
  Vec3 momentum = Vec3::Zero(), angular_momentum = Vec3::Zero();

  void add(const RigidBody& body, const Vec3& g);
  void add(const BodySums& other);
};

/// Start of the present tick rate: the time of tick n is seconds + (n - tick) / rate.
struct Clock {
  uint64_t tick = 0;
  double seconds = 0;
};

/// The algorithms that the settings choose.
struct Methods {
  std::unique_ptr<BroadPhase> broad_phase;
  /// Of the continuous stage, which has other bounds.
  std::unique_ptr<BroadPhase> path_broad_phase;
  NarrowPhase narrow_phase = &collide;
  ContinuousMethods continuous;
  const HierarchyKind* hierarchy = nullptr;  ///< for mesh against mesh; null for "aabb"
};

/// Scratch memory of the stages, kept from tick to tick.
struct Workspace {
  RealtimeSolver solver;
  ContinuousStage continuous;
  ProxySet proxies;
  std::vector<ProxyPair> pairs;
  RealtimeBooks books;
  PairFilter apart;             ///< of the present tick
  std::vector<BodyLink> links;  ///< result of body_links()
  SumsBefore sums_before;
  std::vector<uint8_t> supported;  ///< by slot: held by contacts or joints, for pull_springs()
  PressedNets pressed_nets;
  SleepScratch sleep_scratch;
  std::vector<FastCollision> fast_collisions;  ///< of the present tick, in the order of their time
  EmissionScratch emission;
  FluidWorkspace fluids;
  GrainStage grains;
  GrainReport grain_report;  ///< of the present tick
  SensorScratch sensors;
  std::vector<CourseMotion> courses;  ///< of the present tick
  KeptDrives kept_drives;
};

/// The state before the present tick, which is restored if the tick fails.
struct BeforeTick {
  TickBackup backup;
  StepStats stats;
  Ledger ledger;
};

/// The last frame, and which parts of it the next one can share.
struct FrameState {
  std::shared_ptr<const Frame> last;  ///< the last one that was asked for
  /// What to do when the next frame is asked for, by any thread while no step runs.
  enum class Due : uint8_t { nothing, repeat, make };
  Due due = Due::make;
  std::mutex mutex;
  FramePool pool;
  bool infos_changed = true;  ///< bodies or joints were created or destroyed since the last frame
  std::vector<uint8_t> chunks_changed;  ///< by chunk: changed since the last frame
  /// Chunks_changed may be incomplete: all bodies are compared.
  bool unsure = true;
  uint64_t resting_revision = 0;         ///< revision of the resting contacts in the last frame
  std::vector<const Contact*> contacts;  ///< scratch

  void mark_changed(uint32_t body_slot);
  void forget_bodies();
};

/// Contributions of bodies to the measured sums, by block of slots.
struct BlockSums {
  std::vector<BodySums> blocks;
  std::vector<uint32_t> stale;  ///< blocks that are to be summed again
};

/// Warnings that have been given: each is given once in a world's life, and only counted
/// afterwards.
struct Told {
  bool fallback = false, substituted = false, jam = false, deep = false, dragged = false,
       time_stepped = false, two_fluids = false;
};

/// The whole state of a World. The first group is saved in snapshots; the rest is derived or
/// scratch.
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
  ContactSet particle_contacts;  ///< under realtime; particles are named by their index in:
  std::vector<ParticleName> touching_particles;
  GrainTouches grain_touches;
  EmitterSet emitters;
  SinkSet sinks;
  SensorSet sensors;
  EventStepper event;  ///< its contacts, and the particles that they name
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
  TickWatch* watch = nullptr;      ///< likewise; null: nothing is recorded

  // -- derived by each tick, or scratch
  std::vector<uint32_t> on_course;  ///< slots of bodies whose definition has a course, ascending
  std::vector<uint32_t> forces_on_course;  ///< slots of forces that follow any, ascending
  Methods methods;
  Workspace workspace;
  Roster roster;
  ParticleBlocks blocks;  ///< appended to the bodies during a tick
  IslandSet islands;
  ParticleDetection particle_detection;
  StepStats stats;
  BlockSums sums;
  BeforeTick before;
  Profiler profiler;
  FrameState frames;
  QueryCache queries;
  /// The last tick changed nothing, and later ones will not either until something other than a
  /// tick changes the state: frames are repeated.
  bool still = false;
  /// Bodies may have been created asleep since the last tick; those have no contacts yet.
  bool laid_asleep = true;

  /// A function of the kind that ShapeFactory refers to.
  auto shape_factory() {
    return [this](const ShapeDef& def) { return shapes->shape(def); };
  }
  double time() const { return clock.seconds + settings.tick.time(tick - clock.tick); }
  /// At the end of the tick in progress [s].
  double time_after() const { return clock.seconds + settings.tick.time(tick + 1 - clock.tick); }
  ForceContext force_context();
  /// Marks the bodies that the tick may have changed, for the next frame.
  void mark_active();
  /// Declares that any body may have changed since the last tick.
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

/// The frame of the present state, which is made now if it is out of date.
const std::shared_ptr<const Frame>& present_frame(WorldState& state);

/// Energies, momenta and counts of the present state.
void measure(WorldState& state);
/// To be called after the books of a tick are closed. Error: energy or momentum is not finite, or
/// the energy exceeds a thousand times what came in by all causes in the ledger; it names the body
/// or particle with the most energy.
Status check_energy(const WorldState& state);
/// Energy and momenta as measure() found them last, for the ledger.
LedgerState measured(const WorldState& state);
/// The same for these particles only; `systems` is by slot.
LedgerState measure_particles(WorldState& state, std::vector<ParticleSystem>& systems);

/// An entry of the list of steppers.
struct StepperEntry {
  std::string_view name;
  Status (*step)(WorldState& state);
  bool gathers = false;  ///< its loops are short: Crew::gather keeps the threads for the whole tick
};
/// "event", "realtime".
const std::vector<StepperEntry>& all_steppers();

Bytes save_state(const WorldState& state, bool with_geometry);
/// Replaces the state, or on failure leaves it unchanged; returns the length of the replay log at
/// the time of saving.
Result<uint64_t> load_state(WorldState& state, std::span<const std::byte> snapshot);

}  // namespace tumble
