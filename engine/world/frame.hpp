#pragma once
#include "engine/core/stage_times.hpp"
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/forces/force.hpp"
#include "engine/dynamics/joints/joint.hpp"
#include "engine/world/ledger/ledger.hpp"
#include "engine/world/particle_measures.hpp"
#include "engine/world/sensors/sensor_frame.hpp"
#include "engine/world/time.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tumble {

/// The public state of a body in one frame.
struct BodyFrame {
  BodyId id;                  ///< null: no body in this slot
  Pose pose;                  ///< centre of mass frame in the world
  Vec3 v = Vec3::Zero();      ///< [m/s]
  Vec3 omega = Vec3::Zero();  ///< [rad/s]
  uint32_t island = 0;        ///< number of its contact island; 0: none
  bool asleep = false;
  bool jumped = false;  ///< new or teleported: do not interpolate to here
};

/// The properties of a body that do not change from tick to tick.
struct BodyInfo {
  BodyId id;
  std::string name;
  BodyType type = BodyType::fixed;
  double mass = 0;              ///< [kg]
  Mat3 inertia = Mat3::Zero();  ///< about the centre of mass, body axes [kg m2]
  Vec3 centre_body = Vec3::Zero();
  std::vector<BodyShape> shapes;  ///< poses relative to the centre of mass
  Look look;
  /// What is drawn instead of the shapes; null: the shapes.
  std::shared_ptr<const std::vector<DrawnShape>> drawn{};

  /// Calls f(shape, colour) for every shape that is drawn.
  template <class F>
  void for_seen(const F& f) const {
    if (!drawn)
      for (const BodyShape& s : shapes) f(s, look.colour);
    else
      for (const DrawnShape& s : *drawn) f(s.part, s.colour.value_or(look.colour));
  }
};

struct ContactFrame {
  BodyId a, b;
  Vec3 x_world;         ///< [m]
  Vec3 normal;          ///< from a to b
  double gap;           ///< [m]
  Vec3 impulse;         ///< on b over the last tick [N s]
  double friction = 0;  ///< friction coefficient, the tangent of half the cone's opening angle [-]
};

/// A particle of a system that detects (ParticleSystemDef::detect), and what it touched during the
/// last tick: a shape of a body or another such particle.
struct ParticleContactFrame {
  ParticleSystemId system;
  uint32_t particle = 0;   ///< index in the arrays of ParticleFrame
  BodyId body;             ///< null: another particle
  uint32_t shape = 0;      ///< index in BodyInfo::shapes
  ParticleSystemId other;  ///< null: a body
  uint32_t other_particle = 0;
  Vec3 x_world = Vec3::Zero();  ///< where they touch, or first touched if they are apart again [m]
  Vec3 normal = Vec3::UnitY();  ///< from the particle to the other, at that touch
  double gap = 0;               ///< at the end of the tick, 0 if apart again [m]
  double time = 0;              ///< of the first touch, since the start of the tick [s]
  bool apart_again = false;     ///< they touched during the tick, but no longer at its end
};

struct ForceFrame {
  ForceId id;
  ForceDef def;
  /// World positions of its anchors, in order; NaN for nodes of meshes that no longer exist [m].
  std::vector<Vec3> points;
};

/// A coordinate of a joint.
struct CoordinateFrame {
  double value = 0;  ///< [m], or [rad] counted over full turns
  double rate = 0;   ///< [m/s], [rad/s]
  double motor = 0;  ///< mean force or torque of its motor over the last tick [N], [N m]
};

/// A joint, with its two frames in the world: where these differ along what the joint constrains,
/// that is its error. A null body is the world.
struct JointFrame {
  JointId id;
  std::string name;
  JointKind kind = JointKind::spherical;
  BodyId a, b;
  Pose frame_a, frame_b;  ///< origin: the anchor, z: the main axis
  /// Force on B, and torque about B's anchor: impulses over the last tick divided by its length, in
  /// world axes; zero before the first tick. They differ from the values at the end of the tick by
  /// about half of their change in a tick; World::joint_reactions() gives those.
  Vec3 mean_force = Vec3::Zero();   ///< [N]
  Vec3 mean_torque = Vec3::Zero();  ///< [N m]
  /// In the order of the coordinates of the kind; those beyond its number are unused.
  std::array<CoordinateFrame, most_coordinates> coordinates{};

  /// The coordinate of this name, or null if the kind has none.
  const CoordinateFrame* coordinate(std::string_view named) const {
    const size_t k = coordinate_named(kind, named);
    return k < entry_of(kind).coordinates.size() ? &coordinates[k] : nullptr;
  }
};

struct ParticleFrame {
  ParticleSystemId id;
  std::string name;
  std::vector<Vec3> x;
  std::vector<double> radius;
  std::vector<Vec3f> colour;
  PeriodicBox box;            ///< particles that leave it enter on the opposite side
  std::vector<uint64_t> ids;  ///< ascending; the same particle keeps its id from frame to frame
  double glow = 0;            ///< see ParticleSystemDef
  ParticleMeasures measures;
  ParticleLook look;
  std::vector<float> value;         ///< of the quantity that the look colours by; else empty
  ValueRange range;                 ///< of the colours: given by the look, or all values so far
  std::vector<Vec3f> v;             ///< for drawing a liquid surface [m/s]
  std::vector<float> share;         ///< likewise: density over rest density [-]
  std::vector<float> opacity, age;  ///< for drawing smoke: 0..1 [-]; [s]
  std::vector<double> mass;         ///< [kg]
};

/// Mean force and torque of all fluids on a body over the last tick.
struct FluidForceFrame {
  BodyId body;
  Vec3 force = Vec3::Zero();   ///< [N]
  Vec3 torque = Vec3::Zero();  ///< about the centre of mass [N m]
};

/// Energies of a world [J]; the potential of uniform gravity is 0 in the plane through the origin.
struct Energies {
  double kinetic = 0;
  double gravity = 0;
  double springs = 0;
  double fields = 0;  ///< of attractors, point gravity, pair potentials and the like
  double total() const { return kinetic + gravity + springs + fields; }
};

/// Counts and times of the last tick. Times are not part of state, hash or snapshot.
struct StepStats {
  uint64_t bodies = 0, awake = 0, particles = 0, islands = 0;
  uint64_t bounds_tested = 0;  ///< by the broad phase, in all parts of the tick
  uint64_t pairs_found = 0;    ///< of overlapping bounds
  uint64_t pairs = 0, contacts = 0, contact_points = 0;
  double max_penetration = 0;  ///< [m]
  uint64_t events = 0;         ///< of the event stepper: steps that an event ended early
  uint64_t impacts = 0;        ///< of the event stepper: moments at which impulses acted
  uint64_t fallbacks = 0;      ///< impacts that only the law `sequential` could resolve
  uint64_t time_stepped = 0;   ///< groups of the event stepper that time-stepping moved
  uint64_t joints = 0;         ///< joints that exist
  uint64_t broken_joints = 0;  ///< in the last tick
  Energies energies;
  Vec3 momentum = Vec3::Zero();          ///< [kg m/s]
  Vec3 angular_momentum = Vec3::Zero();  ///< about the origin [kg m2/s]
  StageTimes stages;
};

/// Immutable picture of a world after a tick: the only thing a viewer reads. Unchanged parts are
/// shared between consecutive frames, so that a sleeping world costs nothing.
struct Frame {
  static constexpr size_t chunk_size = 64;
  using BodyChunk = std::array<BodyFrame, chunk_size>;

  uint64_t tick = 0;
  TickRate rate;
  double time = 0;              ///< [s]
  Vec3 gravity = Vec3::Zero();  ///< at this moment [m/s2]
  /// Gravity by whose strength speeds and forces are called small or large [m/s2]: where gravity
  /// follows a course, which may pass through zero, that of the Earth unless it is stronger now.
  double usual_gravity = 0;
  std::string broad_phase;                               ///< name in all_broad_phases()
  std::vector<std::shared_ptr<const BodyChunk>> chunks;  ///< body slot i is chunks[i / 64][i % 64]
  std::shared_ptr<const std::vector<BodyInfo>> infos;    ///< by body slot
  /// Contacts of which a body may move, then those between bodies at rest: the second list is
  /// shared with the last frame as long as no body came to rest or was disturbed. Each is sorted by
  /// bodies.
  std::shared_ptr<const std::vector<ContactFrame>> contacts, resting_contacts;
  /// Sorted by system and particle, bodies before particles; null when no system detects.
  std::shared_ptr<const std::vector<ParticleContactFrame>> particle_contacts;
  std::vector<ForceFrame> forces;
  std::shared_ptr<const std::vector<JointFrame>> joints;  ///< in the order of their slots
  std::vector<std::shared_ptr<const ParticleFrame>> particles;
  /// Bodies that a fluid touched, ascending by slot; empty before the first tick.
  std::vector<FluidForceFrame> fluid_forces;
  /// In the order of their slots; null when there are none.
  std::shared_ptr<const std::vector<SensorFrame>> sensors;
  StepStats stats;
  std::shared_ptr<const Ledger> ledger;  ///< books up to this tick

  size_t body_slots() const { return infos ? infos->size() : 0; }
  const BodyFrame& body(size_t slot) const {
    return (*chunks[slot / chunk_size])[slot % chunk_size];
  }
  /// Zero force for a body that no fluid touched.
  FluidForceFrame fluid_force(BodyId body) const;
  /// Calls f for every contact, those between bodies at rest included.
  template <class F>
  void for_contacts(const F& f) const {
    for (const auto* list : {contacts.get(), resting_contacts.get()})
      if (list)
        for (const ContactFrame& c : *list) f(c);
  }
  /// A copy of all contacts.
  std::vector<ContactFrame> all_contacts() const {
    std::vector<ContactFrame> all;
    for_contacts([&all](const ContactFrame& c) { all.push_back(c); });
    return all;
  }
  const BodyInfo& info(size_t slot) const { return (*infos)[slot]; }
};

/// Kinetic energy of a body of this frame [J], of translation and of rotation with the whole
/// inertia tensor; 0 for fixed and kinematic bodies.
double kinetic_energy(const BodyFrame& body, const BodyInfo& info);

/// Pose of a body slot between two frames of the same world, s in [0, 1]; that of the later frame
/// where the body is new or has jumped.
Pose interpolated_pose(const Frame& from, const Frame& to, size_t slot, double s);

}  // namespace tumble
