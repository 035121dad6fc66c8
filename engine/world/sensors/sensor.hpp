#pragma once
#include "engine/core/bytes.hpp"
#include "engine/core/handle.hpp"
#include "engine/core/result.hpp"
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/particles/particle_system.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

struct SensorTag;
using SensorId = Handle<SensorTag>;

/// What a sensor measures. Sensors do not influence the simulation.
enum class SensorKind : uint8_t {
  gate,     ///< centres that pass through a flat shape, and in which direction
  region,   ///< centres inside a solid shape
  contact,  ///< whether one body touches another one, or any
  radial,   ///< the radial distribution g(r) of particles
};

/// Forms of gates (flat, in the plane y = 0 of their frame) and of regions.
enum class SensorForm : uint8_t { disc, rectangle, box, sphere, cylinder };
inline bool is_flat(SensorForm form) {
  return form == SensorForm::disc || form == SensorForm::rectangle;
}

/// A form, centred at the origin of its frame.
struct SensorShape {
  SensorForm form = SensorForm::disc;
  /// Half the extents [m]; for round forms x is the radius, for a cylinder y is half the height.
  Vec3 half{0.5, 0.5, 0.5};
};
/// Whether a point, in the shape's frame, is inside; for flat forms y is ignored.
bool holds(const SensorShape& shape, const Vec3& x);

struct SensorDef {
  std::string name;
  SensorKind kind = SensorKind::gate;

  // Gates and regions.
  SensorShape shape;
  BodyId carrier;  ///< null: fixed in the world
  Pose pose;       ///< of the shape's frame in the carrier's body frame, or in the world
  /// Which centres are counted: dynamic bodies, particles; only those listed, if the lists are not
  /// empty.
  bool bodies = true, particles = true;
  std::vector<BodyId> only_bodies;
  std::vector<ParticleSystemId> only_systems;
  double span = 1;  ///< of a gate: the flow is the mean over this time, at least one tick [s]

  // Contacts.
  BodyId a, b;  ///< b null: any other body

  // Radial distributions, of the particles of `only_systems` together.
  double range = 1;      ///< greatest distance [m]
  uint32_t shells = 60;  ///< of equal thickness up to there
  static constexpr uint32_t most_shells = 100;
};

/// The error says which value is wrong. Ids need not exist.
Status validate(const SensorDef& def);

/// Mass that passed through a gate in one tick, negative against its y axis.
struct Passage {
  double time = 0;  ///< of the end of the tick [s]
  double mass = 0;  ///< [kg]
};

/// What a sensor has measured since its creation.
struct SensorState {
  double begun = 0;  ///< time of its creation [s]

  // Of a gate.
  uint64_t forward = 0, backward = 0;          ///< passages along its y axis, and against it
  double mass_forward = 0, mass_backward = 0;  ///< mass of these passages [kg]
  double flow = 0;                             ///< mean over the span [kg/s]
  std::vector<Passage> recent;                 ///< within the span, one per tick

  // Of a contact.
  bool touching = false;
  uint64_t touches = 0;       ///< number of times that contact began
  Vec3 force = Vec3::Zero();  ///< mean force on a over the last tick [N]
};

/// All sensors of a world, by slot.
struct SensorSet {
  HandlePool<SensorTag> ids;
  std::vector<SensorDef> defs;
  std::vector<SensorState> states;

  bool empty() const { return ids.count() == 0; }
  void save(ByteWriter& out) const;
  void load(ByteReader& in);
};

void write_sensor_def(ByteWriter& out, const SensorDef& def);
SensorDef read_sensor_def(ByteReader& in);

/// Direction in which a straight path crosses a flat shape: 1 along its y axis, -1 against it, 0 if
/// it does not cross. Both ends are given in the shape's frame at their times. A point in the plane
/// counts as above it, so that of consecutive paths exactly one crosses.
int passage(const SensorShape& shape, const Vec3& from, const Vec3& to);

}  // namespace tumble
