#pragma once
#include "engine/collision/continuous/moving_pair.hpp"

namespace tumble {

/// The method "continuous_triangles": pairs of triangles whose swept bounds meet, found by
/// hierarchies, are tested by facet_contact(), in the order of the earliest possible contact, each
/// only up to the earliest contact so far. Meshes, boxes and hulls are surfaces of triangles; balls
/// are a point and capsules a segment, with their radius.
bool triangles_apply(const MovingPair& pair);
TimeOfContact find_by_triangles(const MovingPair& pair);

}  // namespace tumble
