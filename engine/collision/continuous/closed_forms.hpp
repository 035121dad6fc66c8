#pragma once
#include "engine/collision/continuous/moving_pair.hpp"

namespace tumble {

/// The method "sphere_sphere": two balls whose centres travel straight, by the quadratic of
/// moving_spheres_contact() for radii that are half the tolerance larger.
bool balls_apply(const MovingPair& pair);
TimeOfContact find_by_balls(const MovingPair& pair);

/// The method "box_box": two boxes that turn and travel, by the separating axes of
/// moving_boxes_contact() for boxes that are an eighth of the tolerance larger all round: before
/// they meet, the true ones are a quarter of the tolerance apart, and when they meet, less than
/// half of it.
bool boxes_apply(const MovingPair& pair);
TimeOfContact find_by_boxes(const MovingPair& pair);

}  // namespace tumble
