#pragma once
#include "engine/scene/expression.hpp"
#include "engine/world/frame.hpp"

#include <memory>

namespace tumble {

/// What expressions (--assert) may name about a world: `time`, `tick`, `energy.kinetic`,
/// `.gravity`,
/// `.springs`, `.total`, `momentum.x`, `angular_momentum.x`, `contacts`, `contact_points`, `pairs`,
/// `islands`, `awake`, `bodies`, `particles`, `max_penetration`, and of a body
/// `bodies.NAME.position.x` (centre of mass), `.velocity.x`, `.angular_velocity.x`, `.speed`,
/// `.angular_speed`, `.mass`, `.asleep`, `.tilt_deg` (between its y axis and the vertical),
/// `.orientation.w`. With an initial frame also `initial.` before any of them.
NameLookup world_quantities(std::shared_ptr<const Frame> now,
                            std::shared_ptr<const Frame> initial = nullptr);

}  // namespace tumble
