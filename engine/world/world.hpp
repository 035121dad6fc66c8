#pragma once
#include "engine/core/bytes.hpp"
#include "engine/core/memory_use.hpp"
#include "engine/core/result.hpp"
#include "engine/dynamics/contact/contact_certificate.hpp"
#include "engine/world/command.hpp"
#include "engine/world/frame.hpp"
#include "engine/world/world_def.hpp"

#include <memory>
#include <optional>
#include <span>

namespace tumble {

/// A moment of a world's history: its state and the commands that led to it. Kept, it can be come
/// back to after the history took another course.
struct Moment {
  Bytes snapshot;  ///< without geometry
  ReplayLog log;
};

struct StepReport {
  uint64_t tick = 0;
  StepStats stats;
};

/// What a world query found.
struct WorldRayHit {
  BodyId body;
  uint32_t shape = 0;
  double distance = 0;  ///< [m]
  Vec3 x_world, normal;
};

/// Two bodies that are partly in the same place.
struct Overlap {
  BodyId a, b;
  double depth = 0;  ///< of their deepest contact [m]
};

/// Force and torque of a joint on its body B at one moment, world axes; A feels the reverse at the
/// same point.
struct JointReaction {
  JointId id;
  Vec3 x_world = Vec3::Zero();  ///< B's anchor [m]
  Vec3 force = Vec3::Zero();    ///< [N]
  Vec3 torque = Vec3::Zero();   ///< about B's anchor [N m]
};

class QueryScene;
struct GroupForceProblem;
struct TickWatch;
class StopFlag;
struct WorldState;  // engine/world/state.hpp; for the files of engine/world only

/// A simulated world: bodies, joints, particles, forces and the fixed tick. All change from outside
/// is a Command, queued and applied in order at the start of the next step (or by apply_commands),
/// and written to the replay log. Two worlds share nothing but immutable shapes.
class World {
 public:
  /// A world with nothing in it; `shapes` may be shared between worlds to save memory.
  static Result<std::unique_ptr<World>> create(WorldDef def = {},
                                               std::shared_ptr<ShapeStore> shapes = nullptr);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  // -- commands: validated now, applied at the start of the next step; ids are valid at once ------
  Result<BodyId> create_body(BodyDef def);
  Status destroy_body(BodyId id);
  /// Replaces the definition of a live body: shapes, materials, mass, kind, pose, velocities.
  /// Change what body_def() gives. Joints and forces at the body stay where they are in its frame.
  Status set_body(BodyId id, BodyDef def);
  /// Places the definition's body frame; the viewer does not interpolate across it.
  Status set_pose(BodyId id, const Pose& body_frame);
  Status set_velocity(BodyId id, const Vec3& v, const Vec3& omega);
  /// Impulse [N s] at a world point.
  Status apply_impulse(BodyId id, const Vec3& impulse, const Vec3& x_world);
  Result<ForceId> create_force(ForceDef def);
  /// Replaces the definition of a live force (the mouse moves its target so).
  Status set_force(ForceId id, ForceDef def);
  Status destroy_force(ForceId id);
  /// Destroyed with either of its bodies.
  Result<JointId> create_joint(JointDef def);
  /// Replaces the definition of a live joint.
  Status set_joint(JointId id, JointDef def);
  Status destroy_joint(JointId id);
  Result<ParticleSystemId> create_particles(ParticleSystemDef def);
  Status destroy_particles(ParticleSystemId id);
  /// Replaces the definition of a live system; whatever names it stays. It begins anew with the
  /// particles of the definition, whose numbers are given again. With `keep` those that it has stay
  /// and move on, and take mass, radius, colour and life of the one of the definition that has
  /// their number, if one has.
  Status set_particles(ParticleSystemId id, ParticleSystemDef def, bool keep = false);
  /// Emits from the next tick on; the emitters that its events name exist already, so that events
  /// never go round in a circle.
  Result<EmitterId> create_emitter(EmitterDef def);
  /// Replaces the definition of a live emitter: times count from when it was made, and what it has
  /// made by then is made. Error also where its events would lead back to it.
  Status set_emitter(EmitterId id, EmitterDef def);
  /// What it made stays.
  Status destroy_emitter(EmitterId id);
  Result<SinkId> create_sink(SinkDef def);
  Status destroy_sink(SinkId id);
  /// Measures from then on, and changes nothing; what it measures may go before it.
  Result<SensorId> create_sensor(SensorDef def);
  Status destroy_sensor(SensorId id);
  Status set_settings(const WorldSettings& settings);
  /// Queues a command of a replay log as it stands.
  Status submit(Command command);
  /// Applies what is queued without stepping; the frame shows it.
  Status apply_commands();

  // -- time ---------------------------------------------------------------------------------------
  /// Advances by one tick. After an error the world is back at the last good tick. One of them is
  /// `cancelled`: see stop_with().
  Result<StepReport> step();
  /// What stops a tick: once the flag is requested, by any thread or a signal handler, the tick
  /// under way ends within a tenth of a second, and so do later ones at once, until it is cleared.
  /// Commands wait for the next tick, or were carried out before this one. Null: nothing does.
  void stop_with(const StopFlag* flag);
  /// From then on each tick writes down how it was computed, in what must live as long; null: none
  /// does.
  void watch_with(TickWatch* watch);
  uint64_t tick() const;
  double time() const;  ///< [s]
  const WorldSettings& settings() const;
  void set_threads(int threads);  ///< 0: one per core; results do not depend on it

  // -- observation --------------------------------------------------------------------------------
  /// The state after the last step or apply_commands; never null, may be kept for ever. Made at
  /// the first question after a change: who steps without looking does not pay for it. Any number
  /// of threads may ask while none steps.
  std::shared_ptr<const Frame> frame() const;
  uint64_t state_hash() const;
  /// What the arrays of the world and of the realtime stepper hold now, without the broad phase's
  /// own and without geometry, which worlds share.
  MemoryUse memory_use() const;
  /// The shapes of frame() for rays, casts, overlaps and nearest points (queries/query_scene.hpp).
  /// Made at the first question after a change and then shared; may be kept for ever. Any number
  /// of threads may ask while none steps.
  std::shared_ptr<const QueryScene> queries() const;
  /// Nearest hit along a ray (direction need not be unit); bodies only. Nothing for what
  /// queries()->ray() refuses, and for a direction of zero.
  std::optional<WorldRayHit> ray_cast(const Vec3& origin, const Vec3& direction,
                                      double max_distance) const;
  /// Pairs of bodies that overlap now by more than `deeper` [m], deepest first; found anew.
  std::vector<Overlap> overlaps(double deeper) const;
  /// What every contact of frame() claims: gap, velocities, force, place in the friction cone,
  /// residuals, and under the event stepper the balance of forces on every body. Error: the forces
  /// cannot be solved for.
  Result<ContactCertificates> contact_certificates() const;
  /// The problem of contact forces, with cones of friction, of the bodies that touch this one or
  /// are tied to it by joints, as the event stepper poses it at this moment, and its answer. Error:
  /// another stepper, a body that is gone, or forces of which not even the problem is known.
  Result<GroupForceProblem> contact_force_problem(BodyId body) const;
  /// What every live joint does to its bodies at this moment, in the order of their slots: at the
  /// present poses and velocities, under gravity, forces and contacts as they are now, before the
  /// first step too. Contacts are those of the last tick: under the event stepper their forces are
  /// solved for along with the joints', under realtime they press with the means over that tick.
  /// Where joints share a load in many ways it is shared as if all were equally stiff. Error: the
  /// forces cannot be solved for.
  Result<std::vector<JointReaction>> joint_reactions() const;
  /// Live state of a body, or null; valid until the next non-const call.
  const RigidBody* body(BodyId id) const;
  /// The definition that a body was made from, with its current pose and velocities.
  std::optional<BodyDef> body_def(BodyId id) const;
  BodyId find_body(std::string_view name) const;  ///< null id when there is none
  const ForceDef* force(ForceId id) const;
  const JointDef* joint(JointId id) const;
  JointId find_joint(std::string_view name) const;  ///< null id when there is none
  const ParticleSystem* particles(ParticleSystemId id) const;
  const Emitter* emitter(EmitterId id) const;
  const SinkDef* sink(SinkId id) const;
  const SensorDef* sensor(SensorId id) const;

  // -- snapshot and replay
  // --------------------------------------------------------------------------
  /// The whole state as bytes in named, versioned sections. Without geometry, meshes and hulls are
  /// stored by content hash and must be in the shape store of the loading world.
  Bytes save(bool with_geometry = true) const;
  /// Replaces the whole state, which becomes the origin of a new replay log; on failure the world
  /// is as before.
  Status load(std::span<const std::byte> snapshot);
  /// Goes back to a snapshot of this world's own past; the replay log forgets what came after it.
  Status rewind(std::span<const std::byte> snapshot);
  Moment moment() const;
  /// Goes to a moment of this world's history, also on a course that has been left since; the
  /// replay log is the one of that moment. On failure the world is as before.
  Status restore(const Moment& moment);
  /// Every command since the origin with the tick at which it was applied.
  const ReplayLog& replay_log() const;

 private:
  explicit World(std::unique_ptr<WorldState> state);
  std::unique_ptr<WorldState> state_;
};

}  // namespace tumble
