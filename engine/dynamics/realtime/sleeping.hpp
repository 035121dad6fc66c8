#pragma once
#include "engine/dynamics/islands/islands.hpp"
#include "engine/dynamics/realtime/realtime_settings.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// Scratch memory of update_sleeping.
struct SleepScratch {
  std::vector<double> rested;  ///< by member of IslandSet::bodies: how long it has rested [s]
};

/// Counts how long each awake body's averaged velocity has been small, and puts islands to sleep
/// all of whose bodies rested for settings.sleep_time. `gravity` is the magnitude [m/s2], `h` the
/// tick [s]. Returns the number of islands that fell asleep. Runs on the threads of the crew, if
/// there is one.
uint32_t update_sleeping(std::span<RigidBody> bodies, const IslandSet& islands, double gravity,
                         double h, const RealtimeSettings& settings, SleepScratch& scratch,
                         Crew* crew = nullptr);

}  // namespace tumble
