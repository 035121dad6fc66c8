#pragma once
#include "engine/geometry/hierarchy/hierarchy.hpp"

namespace tumble {

/// How far a convex body reaches outside a mesh, at `samples` points of its surface and as many of
/// its inside; 0 where none lies outside. Stops at the first that is farther than `enough` [m].
double reach_outside(const TriangleMesh& convex, const Hierarchy& surface, size_t samples,
                     double enough);

}  // namespace tumble
