#pragma once
#include "engine/dynamics/contact/contact_set.hpp"
#include "engine/dynamics/contact/realtime_settings.hpp"
#include "engine/dynamics/rigid/islands.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// Memory that update_sleeping uses again.
struct SleepScratch {
  std::vector<uint8_t> pulled;   ///< by member of IslandSet::bodies: pulled along
  std::vector<uint8_t> settles;  ///< by island
  std::vector<double> rested;    ///< by member [s]
};

/// Damps what is nearly at rest in contact (settings.settling) where nothing but gravity pulls at
/// the island, counts how long each awake body has been slow or trembling in one place, and puts
/// islands to sleep whose bodies all were for settings.sleep_time. `gravity` is the magnitude
/// [m/s2]. Gives the number of islands that fell asleep. On the threads of the crew, if there is
/// one.
uint32_t update_sleeping(std::span<RigidBody> bodies, const IslandSet& islands, double gravity,
                         double h, const RealtimeSettings& settings, SleepScratch& scratch,
                         Crew* crew = nullptr);

/// Wakes a body; the bodies that it touches follow in build_islands.
void wake(RigidBody& body);

/// Wakes everything that touches `body`: before it is removed, teleported, or its velocity is set.
void wake_touching(std::span<RigidBody> bodies, const ContactSet& contacts, uint32_t body);

/// Wakes every body (gravity or another global setting changed).
void wake_all(std::span<RigidBody> bodies);

}  // namespace tumble
