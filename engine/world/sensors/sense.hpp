#pragma once
#include "engine/world/sensors/sensor_frame.hpp"

#include <vector>

namespace tumble {

struct WorldState;

/// The straight path of a centre of mass from the beginning to the end of a tick.
struct CentrePath {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< [m]
  double mass = 0;                              ///< [kg]
  BodyId body;                                  ///< null for particles
};

/// Scratch memory of the stage, kept from tick to tick.
struct SensorScratch {
  std::vector<CentrePath> bodies;
  std::vector<std::vector<CentrePath>> particles;  ///< by system
};

/// The stage at the end of a successful tick: gates count the centres that passed through them
/// during the tick, contact sensors are evaluated. Paths of particles born in the tick begin at
/// their birth; particles that died in it are followed to where they died. Without sensors it does
/// nothing.
void sense_tick(WorldState& state);

/// Whether readings change in ticks in which nothing moves: the flow of a gate's last span does.
bool sensing_goes_on(const WorldState& state);

/// The readings of all sensors, in the order of their slots; `out` is overwritten, and its memory
/// reused.
void make_sensor_frames(const WorldState& state, std::vector<SensorFrame>& out);

}  // namespace tumble
