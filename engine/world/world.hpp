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

/// A moment of a world's history: its state and the commands that led to it. A world can return to
/// it even after its history has taken another course.
struct Moment {
  Bytes snapshot;  ///< without geometry
  ReplayLog log;
};

struct StepReport {
  uint64_t tick = 0;
  StepStats stats;
};

/// A hit of World::ray_cast.
struct WorldRayHit {
  BodyId body;
  uint32_t shape = 0;
  double distance = 0;  ///< [m]
  Vec3 x_world, normal;
};

/// Two bodies that overlap.
struct Overlap {
  BodyId a, b;
  double depth = 0;  ///< of their deepest contact [m]
};

/// Force and torque of a joint on its body B at one moment, world axes; A receives the opposite
/// force and torque at the same point.
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

/// A simulated world: bodies, joints, particles and forces, advanced in fixed ticks. Every change
/// from outside is a Command, which is queued, applied in order at the start of the next step (or
/// by apply_commands), and written to the replay log. Worlds share nothing but immutable shapes.
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
  /// Replaces the definition of a live body: shapes, materials, mass, kind, pose, velocities. Start
  /// from body_def(). Joints and forces attached to the body keep their anchors in its frame.
  Status set_body(BodyId id, BodyDef def);
  /// Sets the pose of the definition's body frame; viewers do not interpolate across the change.
  Status set_pose(BodyId id, const Pose& body_frame);
  Status set_velocity(BodyId id, const Vec3& v, const Vec3& omega);
  /// Impulse [N s] at a world point.
  Status apply_impulse(BodyId id, const Vec3& impulse, const Vec3& x_world);
  Result<ForceId> create_force(ForceDef def);
  /// Replaces the definition of a live force; the mouse moves its target this way.
  Status set_force(ForceId id, ForceDef def);
  Status destroy_force(ForceId id);
  /// A joint is destroyed with either of its bodies.
  Result<JointId> create_joint(JointDef def);
  /// Replaces the definition of a live joint.
  Status set_joint(JointId id, JointDef def);
  Status destroy_joint(JointId id);
  Result<ParticleSystemId> create_particles(ParticleSystemDef def);
  Status destroy_particles(ParticleSystemId id);
  /// Replaces the definition of a live system; its id stays valid. The system begins anew with the
  /// particles of the definition, whose ids count from 1 again. With `keep` its particles stay and
  /// move on, and take mass, radius, colour and life from the particle of the definition with the
  /// same id, if there is one.
  Status set_particles(ParticleSystemId id, ParticleSystemDef def, bool keep = false);
  /// Emits from the next tick on. Emitters that its events name must exist already, so that events
  /// cannot form a cycle.
  Result<EmitterId> create_emitter(EmitterDef def);
  /// Replaces the definition of a live emitter: times still count from its creation, and what the
  /// new definition would have emitted before now is not emitted. Error also if its events would
  /// lead back to it.
  Status set_emitter(EmitterId id, EmitterDef def);
  /// What it emitted stays.
  Status destroy_emitter(EmitterId id);
  Result<SinkId> create_sink(SinkDef def);
  Status destroy_sink(SinkId id);
  /// Measures from then on; what it measures may be destroyed before it.
  Result<SensorId> create_sensor(SensorDef def);
  Status destroy_sensor(SensorId id);
  Status set_settings(const WorldSettings& settings);
  /// Queues a command of a replay log unchanged.
  Status submit(Command command);
  /// Applies the queued commands without stepping; the next frame shows their effect.
  Status apply_commands();

  // -- time ---------------------------------------------------------------------------------------
  /// Advances by one tick. After an error the world is in the state of the last good tick. One
  /// possible error is `cancelled`: see stop_with().
  Result<StepReport> step();
  /// Sets the flag that stops a tick: when it is requested, by any thread or a signal handler, the
  /// tick in progress ends within a tenth of a second, and later ones end at once until it is
  /// cleared. Queued commands either wait for the next tick, or were applied before this one. Null:
  /// ticks cannot be stopped.
  void stop_with(const StopFlag* flag);
  /// From then on each tick records how it was computed in `watch`, which must outlive its use;
  /// null: none does.
  void watch_with(TickWatch* watch);
  uint64_t tick() const;
  double time() const;  ///< [s]
  const WorldSettings& settings() const;
  void set_threads(int threads);  ///< 0: one per core; results do not depend on it

  // -- observation --------------------------------------------------------------------------------
  /// The state after the last step or apply_commands; never null, and may be kept as long as one
  /// likes. Made at the first call after a change, so that steps without a viewer do not pay for
  /// it. Any number of threads may call while no step runs.
  std::shared_ptr<const Frame> frame() const;
  uint64_t state_hash() const;
  /// Memory that the arrays of the world and of the realtime stepper hold now, without that of the
  /// broad phase, and without geometry, which worlds share.
  MemoryUse memory_use() const;
  /// The shapes of frame() for rays, casts, overlaps and nearest points (queries/query_scene.hpp).
  /// Made at the first call after a change and then shared; may be kept. Any number of threads may
  /// call while no step runs.
  std::shared_ptr<const QueryScene> queries() const;
  /// Nearest hit along a ray, on bodies only; the direction need not be unit. Empty if
  /// queries()->ray() would return an error, and for a direction of zero.
  std::optional<WorldRayHit> ray_cast(const Vec3& origin, const Vec3& direction,
                                      double max_distance) const;
  /// Pairs of bodies that overlap now by more than `deeper` [m], deepest first; computed by this
  /// call.
  std::vector<Overlap> overlaps(double deeper) const;
  /// The conditions that every contact of frame() satisfies: gap, velocities, force, position in
  /// the friction cone, residuals, and under the event stepper the balance of forces on every body.
  /// Error: the forces cannot be solved for.
  Result<ContactCertificates> contact_certificates() const;
  /// The contact force problem, with friction cones, of the group of bodies connected with this one
  /// by contacts or joints, as the event stepper poses it at this moment, and its solution. Error:
  /// another stepper, a body that does not exist, or a problem that cannot be posed.
  Result<GroupForceProblem> contact_force_problem(BodyId body) const;
  /// Force and torque of every live joint at this moment, in the order of their slots: at the
  /// present poses and velocities, under the present gravity, forces and contacts; also before the
  /// first step. Contacts are those of the last tick: under the event stepper their forces are
  /// solved for together with those of the joints, under realtime they act with their mean forces
  /// over that tick. Where the forces of joints are not unique, the load is shared as if all joints
  /// were equally stiff. Error: the forces cannot be solved for.
  Result<std::vector<JointReaction>> joint_reactions() const;
  /// Live state of a body, or null; valid until the next non-const call.
  const RigidBody* body(BodyId id) const;
  /// The definition that a body was created from, with its current pose and velocities.
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
  /// stored as content hashes, and the shape store of the loading world must have them.
  Bytes save(bool with_geometry = true) const;
  /// Replaces the whole state, which becomes the origin of a new replay log; on failure the world
  /// is as before.
  Status load(std::span<const std::byte> snapshot);
  /// Goes back to a snapshot of this world's own past; the replay log is cut off after it.
  Status rewind(std::span<const std::byte> snapshot);
  Moment moment() const;
  /// Goes to a moment of this world's history, also of a course that it has left since; the replay
  /// log becomes the one of that moment. On failure the world is unchanged.
  Status restore(const Moment& moment);
  /// Every command since the origin with the tick at which it was applied.
  const ReplayLog& replay_log() const;

 private:
  explicit World(std::unique_ptr<WorldState> state);
  std::unique_ptr<WorldState> state_;
};

}  // namespace tumble
