#pragma once
#include "engine/world/sensors/sensor.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// The readings of a sensor in a frame.
struct SensorFrame {
  SensorId id;
  std::string name;
  SensorKind kind = SensorKind::gate;
  bool gone = false;  ///< its carrier, or its body a, no longer exists
  SensorShape shape;
  Pose pose;       ///< of its shape's frame in the world
  BodyId carrier;  ///< null: fixed in the world
  BodyId a, b;     ///< of a contact

  // Of a gate: passages and mass along its y axis and against it, since its creation.
  uint64_t forward = 0, backward = 0;
  double mass_forward = 0, mass_backward = 0;  ///< [kg]
  double flow = 0;                             ///< mean over its span [kg/s]

  // Of a region.
  std::vector<BodyId> inside;  ///< dynamic bodies whose centre of mass is in it, by slot
  uint64_t particles = 0;      ///< number of particles in it
  double mass = 0;             ///< of both [kg]

  // Of a contact.
  bool touching = false;
  uint64_t touches = 0;       ///< number of times that contact began, since its creation
  Vec3 force = Vec3::Zero();  ///< mean force on a over the last tick [N]

  // Of a radial distribution.
  double range = 0;            ///< [m]
  std::vector<double> shells;  ///< g(r) of shells of equal thickness up to it [-]
};

/// One of the readings of a sensor.
struct SensorValue {
  std::string_view name;  ///< "count", "force.x"
  std::string_view unit;  ///< "" for counts
  double value = 0;
};
/// All readings, in an order that depends only on the sensor's kind.
std::vector<SensorValue> sensor_values(const SensorFrame& sensor);

}  // namespace tumble
