#pragma once
#include "engine/dynamics/bodies/proxies.hpp"
#include "engine/dynamics/realtime/realtime_settings.hpp"

#include <span>

namespace tumble {

/// In how many equal parts a tick of `h` seconds is taken, contacts being found anew in each: 1,
/// unless meshes near each other move far in a tick for how thin they are. The contacts found at
/// the start then say little about its end: a ring that spins by half its gauge has other points
/// in touch. Convex shapes do without: from any side they have one surface. At most
/// settings.max_parts.
int tick_parts(std::span<const RigidBody> bodies, const ProxySet& proxies,
               std::span<const ProxyPair> pairs, double h, const RealtimeSettings& settings);

/// The settings for one of `parts` parts: sub-steps stay as long as they were.
RealtimeSettings part_settings(const RealtimeSettings& settings, int parts);

}  // namespace tumble
