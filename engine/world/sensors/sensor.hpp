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

/// What a sensor measures. None does anything to what it measures.
enum class SensorKind : uint8_t {
  gate,     ///< what goes through a flat shape, and which way
  region,   ///< what is in a solid shape
  contact,  ///< whether a body touches another, or anything
  radial,   ///< at what distances from each other particles are
};

/// Forms of gates (flat, in the plane y = 0 of their frame) and of regions.
enum class SensorForm : uint8_t { disc, rectangle, box, sphere, cylinder };
inline bool is_flat(SensorForm form) {
  return form == SensorForm::disc || form == SensorForm::rectangle;
}

/// A form about the origin of its frame.
struct SensorShape {
  SensorForm form = SensorForm::disc;
  /// Half the extents [m]; of what is round x is the radius, of a cylinder y half the height.
  Vec3 half{0.5, 0.5, 0.5};
};
/// Whether a point of the shape's frame is in it; of flat forms y does not matter.
bool holds(const SensorShape& shape, const Vec3& x);

struct SensorDef {
  std::string name;
  SensorKind kind = SensorKind::gate;

  // Gates and regions.
  SensorShape shape;
  BodyId carrier;  ///< null: it stands in space
  Pose pose;       ///< of the shape's frame in the carrier's body frame, or in the world
  /// Whose centres it looks at: dynamic bodies, particles; only these where lists are not empty.
  bool bodies = true, particles = true;
  std::vector<BodyId> only_bodies;
  std::vector<ParticleSystemId> only_systems;
  double span = 1;  ///< of a gate: its flow is the mean over so long, ticks at least [s]

  // Contacts.
  BodyId a, b;  ///< b null: any other body

  // Radial distributions, of the particles of `only_systems` together.
  double range = 1;      ///< greatest distance [m]
  uint32_t shells = 60;  ///< of equal thickness up to there
  static constexpr uint32_t most_shells = 100;
};

/// Says which value is wrong. What it names need not exist.
Status validate(const SensorDef& def);

/// Mass that went through a gate in one tick, against its y axis negative.
struct Passage {
  double time = 0;  ///< of the end of the tick [s]
  double mass = 0;  ///< [kg]
};

/// What a sensor has measured since it was made.
struct SensorState {
  double begun = 0;  ///< when it was made [s]

  // Of a gate.
  uint64_t forward = 0, backward = 0;          ///< passages along its y axis, and against it
  double mass_forward = 0, mass_backward = 0;  ///< of these [kg]
  double flow = 0;                             ///< in the mean of the span [kg/s]
  std::vector<Passage> recent;                 ///< of the span, a tick each

  // Of a contact.
  bool touching = false;
  uint64_t touches = 0;       ///< beginnings of touch
  Vec3 force = Vec3::Zero();  ///< on a, in the mean of the last tick [N]
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

/// Which way a straight path goes through a flat shape, both ends given in the shape's frame at
/// their time: 1 along its y axis, -1 against it, 0 not at all. A point of the plane counts as
/// above it, so that of paths that follow each other exactly one goes through.
int passage(const SensorShape& shape, const Vec3& from, const Vec3& to);

}  // namespace tumble
