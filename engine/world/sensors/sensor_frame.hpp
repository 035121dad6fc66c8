#pragma once
#include "engine/world/sensors/sensor.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// What a sensor says at a moment.
struct SensorFrame {
  SensorId id;
  std::string name;
  SensorKind kind = SensorKind::gate;
  bool gone = false;  ///< what it is on, or its body a, does not exist any more
  SensorShape shape;
  Pose pose;       ///< of its shape's frame in the world
  BodyId carrier;  ///< null: it stands in space
  BodyId a, b;     ///< of a contact

  // Of a gate: passages, and mass, along its y axis and against it, since the start.
  uint64_t forward = 0, backward = 0;
  double mass_forward = 0, mass_backward = 0;  ///< [kg]
  double flow = 0;                             ///< in the mean of its span [kg/s]

  // Of a region.
  std::vector<BodyId> inside;  ///< dynamic bodies whose centre of mass is in it, by slot
  uint64_t particles = 0;      ///< likewise
  double mass = 0;             ///< of both [kg]

  // Of a contact.
  bool touching = false;
  uint64_t touches = 0;       ///< beginnings of touch since the start
  Vec3 force = Vec3::Zero();  ///< on a, in the mean of the last tick [N]

  // Of a radial distribution.
  double range = 0;            ///< [m]
  std::vector<double> shells;  ///< g(r) of shells of equal thickness up to it [-]
};

/// One of the numbers that a sensor says.
struct SensorValue {
  std::string_view name;  ///< "count", "force.x"
  std::string_view unit;  ///< "" for counts
  double value = 0;
};
/// All of them, in an order that only its kind decides.
std::vector<SensorValue> sensor_values(const SensorFrame& sensor);

}  // namespace tumble
