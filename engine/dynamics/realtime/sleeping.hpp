#pragma once
#include "engine/dynamics/islands/islands.hpp"
#include "engine/dynamics/realtime/realtime_settings.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// Memory that update_sleeping uses again.
struct SleepScratch {
  std::vector<double> rested;  ///< by member of IslandSet::bodies [s]
};

/// Counts how long each awake body has been slow in the mean, and puts islands to sleep whose
/// bodies all were for settings.sleep_time. `gravity` is the magnitude [m/s2]. Gives the number of
/// islands that fell asleep. On the threads of the crew, if there is one.
uint32_t update_sleeping(std::span<RigidBody> bodies, const IslandSet& islands, double gravity,
                         double h, const RealtimeSettings& settings, SleepScratch& scratch,
                         Crew* crew = nullptr);

}  // namespace tumble
