#pragma once
#include "engine/collision/continuous/moving_pair.hpp"

namespace tumble {

/// The method "continuous_triangles": triangles that the swept hierarchies of two surfaces bring
/// together are tested by facet_contact(), those that can meet first before the others, each only
/// up to the earliest contact so far. Meshes, boxes and hulls are surfaces of triangles, balls a
/// point and capsules a segment with their rounding.
bool triangles_apply(const MovingPair& pair);
TimeOfContact find_by_triangles(const MovingPair& pair);

}  // namespace tumble
