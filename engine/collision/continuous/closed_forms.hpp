#pragma once
#include "engine/collision/continuous/moving_pair.hpp"

namespace tumble {

/// The method "sphere_sphere": two balls whose centres move in straight lines, by the quadratic
/// equation of moving_spheres_contact() with radii enlarged by half the tolerance.
bool balls_apply(const MovingPair& pair);
TimeOfContact find_by_balls(const MovingPair& pair);

/// The method "box_box": two rotating and translating boxes, by the separating axes of
/// moving_boxes_contact() for boxes enlarged by an eighth of the tolerance on all sides: before
/// these meet, the true boxes are at least a quarter of the tolerance apart, and when they meet,
/// less than half of it.
bool boxes_apply(const MovingPair& pair);
TimeOfContact find_by_boxes(const MovingPair& pair);

}  // namespace tumble
