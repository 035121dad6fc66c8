#pragma once
#include "engine/world/sensors/sensor_frame.hpp"

#include <vector>

namespace tumble {

struct WorldState;

/// The straight path of a centre from the beginning to the end of a tick.
struct CentrePath {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< [m]
  double mass = 0;                              ///< [kg]
  BodyId body;                                  ///< null for particles
};

/// Memory of the stage, kept from tick to tick.
struct SensorScratch {
  std::vector<CentrePath> bodies;
  std::vector<std::vector<CentrePath>> particles;  ///< by system
};

/// The stage at the end of a tick that has succeeded: gates count who went through them since its
/// beginning, contacts are looked up. Particles born in the tick come from where they were born;
/// those that died in it went as far as they came. Without sensors it does nothing.
void sense_tick(WorldState& state);

/// Whether ticks in which nothing moves change what sensors say: the flow of the last span.
bool sensing_goes_on(const WorldState& state);

/// What the sensors say now, in the order of their slots; over what `out` held.
void make_sensor_frames(const WorldState& state, std::vector<SensorFrame>& out);

}  // namespace tumble
