#pragma once
#include "engine/geometry/hierarchy/hierarchy.hpp"

namespace tumble {

/// How far a convex body extends beyond a mesh, at `samples` points of its surface and as many of
/// its interior; 0 if none is outside. Stops at the first that is farther than `enough` [m].
double reach_outside(const TriangleMesh& convex, const Hierarchy& surface, size_t samples,
                     double enough);

}  // namespace tumble
