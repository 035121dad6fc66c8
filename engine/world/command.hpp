#pragma once
#include "engine/core/bytes.hpp"
#include "engine/core/result.hpp"
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/forces/force.hpp"
#include "engine/dynamics/joints/joint.hpp"
#include "engine/dynamics/particles/emitter.hpp"
#include "engine/dynamics/particles/particle_system.hpp"
#include "engine/dynamics/particles/sink.hpp"
#include "engine/world/sensors/sensor.hpp"
#include "engine/world/settings.hpp"

#include <cstdint>
#include <string_view>
#include <variant>
#include <vector>

namespace tumble {

struct CreateBody {
  BodyId id;
  BodyDef def;
};
struct DestroyBody {
  BodyId id;
};
/// Replaces the definition of a live body, pose and velocities included; its joints and forces
/// stay.
struct SetBody {
  BodyId id;
  BodyDef def;
};
struct SetPose {
  BodyId id;
  Pose body_frame;
};
struct SetVelocity {
  BodyId id;
  Vec3 v = Vec3::Zero(), omega = Vec3::Zero();
};
struct ApplyImpulse {
  BodyId id;
  Vec3 impulse = Vec3::Zero(), x_world = Vec3::Zero();
};
struct CreateForce {
  ForceId id;
  ForceDef def;
};
struct SetForce {
  ForceId id;
  ForceDef def;
};
struct DestroyForce {
  ForceId id;
};
struct CreateParticles {
  ParticleSystemId id;
  ParticleSystemDef def;
};
struct DestroyParticles {
  ParticleSystemId id;
};
/// Replaces the definition of a live system: it begins anew, or with `keep` goes on with the
/// particles that it has.
struct SetParticles {
  ParticleSystemId id;
  ParticleSystemDef def;
  bool keep = false;  ///< particles that exist stay where they are
};
struct SetSettings {
  WorldSettings settings;
};
struct CreateJoint {
  JointId id;
  JointDef def;
};
struct SetJoint {
  JointId id;
  JointDef def;
};
struct DestroyJoint {
  JointId id;
};
struct CreateEmitter {
  EmitterId id;
  EmitterDef def;
};
struct DestroyEmitter {
  EmitterId id;
};
/// Replaces the definition of a live emitter, which goes on from its present state.
struct SetEmitter {
  EmitterId id;
  EmitterDef def;
};
struct CreateSink {
  SinkId id;
  SinkDef def;
};
struct DestroySink {
  SinkId id;
};
struct CreateSensor {
  SensorId id;
  SensorDef def;
};
struct DestroySensor {
  SensorId id;
};

/// Every way in which a world is changed from outside. To add one: an alternative here, its bytes
/// in command.cpp, its effect in apply_command.cpp.
using Command =
    std::variant<CreateBody, DestroyBody, SetPose, SetVelocity, ApplyImpulse, CreateForce, SetForce,
                 DestroyForce, CreateParticles, DestroyParticles, SetSettings, CreateJoint,
                 SetJoint, DestroyJoint, CreateEmitter, DestroyEmitter, CreateSink, DestroySink,
                 SetBody, CreateSensor, DestroySensor, SetParticles, SetEmitter>;

/// Geometry inside commands is written by content hash; the ShapeStore holds the content.
class ShapeStore;
void write_command(ByteWriter& out, const Command& command, ShapeStore& shapes);
Result<Command> read_command(ByteReader& in, const ShapeStore& shapes);

struct LoggedCommand {
  uint64_t tick = 0;  ///< the command was applied before the step that begins at this tick
  Command command;
};

/// All commands since a world's origin, in order. Applied to a world in the state of the origin
/// they give the same bits again.
class ReplayLog {
 public:
  // All defined in command.cpp: copying and destroying commands of every kind takes long to
  // compile.
  ReplayLog();
  ~ReplayLog();
  ReplayLog(const ReplayLog&);
  ReplayLog(ReplayLog&&) noexcept;
  ReplayLog& operator=(const ReplayLog&);
  ReplayLog& operator=(ReplayLog&&) noexcept;

  void add(uint64_t tick, Command command);
  const std::vector<LoggedCommand>& entries() const { return entries_; }
  /// Keeps the first `count` commands only, for a world that steps back and then takes another
  /// course.
  void truncate(size_t count);
  /// Snapshot of the world before the first entry.
  const Bytes& origin() const { return origin_; }
  void restart(Bytes origin);

 private:
  Bytes origin_;
  std::vector<LoggedCommand> entries_;
};

}  // namespace tumble
