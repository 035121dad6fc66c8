#pragma once
#include "tests/fuzz/random_scene.hpp"

#include <string>

namespace tumble {

/// What a run of a random scene came to.
struct SceneVerdict {
  std::string fault;         ///< why it is wrong, in a sentence; empty: right
  double cpu = 0;            ///< of all ticks [s]
  double slowest_tick = 0;   ///< [s of processor]
  double overlap = 0;        ///< deepest at ten moments, of the smaller body's radius [-]
  double energy_excess = 0;  ///< grown beyond booked work, of the energy that was there [-]
  int time_stepped = 0;      ///< ticks of the event stepper in which time-stepping carried a group
  bool right() const { return fault.empty(); }
  std::string text() const;  ///< one line
};

/// Runs a scene for `seconds` of its time and judges it by what holds for every scene in a closed
/// box, whatever the solver: it ends, every number is finite, nothing leaves the box, bodies do not
/// stay in each other, and energy comes from booked work only. Takes no limits of its own.
SceneVerdict judge_scene(const RandomScene& scene, const std::string& stepper, double seconds = 1);

}  // namespace tumble
