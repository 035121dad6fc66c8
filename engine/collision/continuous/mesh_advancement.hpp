#pragma once
#include "engine/collision/mesh_pairs/mesh_surface.hpp"
#include "engine/collision/time_of_contact.hpp"

namespace tumble {

// Conservative advancement with meshes: the interval is split so that on each part neither shape
// moves much farther than its own size; the triangles that the swept bounds can meet on a part are
// advanced one by one, each only up to the earliest contact so far.

/// A convex shape with a mesh.
TimeOfContact advance_convex_mesh(const Shape& a, const Motion& motion_a, const MeshSurface& b,
                                  const Motion& motion_b, double lever_b, double tolerance);
TimeOfContact advance_mesh_mesh(const MeshSurface& a, const Motion& motion_a, double lever_a,
                                const MeshSurface& b, const Motion& motion_b, double lever_b,
                                double tolerance);
/// The half-space y <= 0 of a moving frame (A) with the vertices of a mesh.
TimeOfContact advance_half_space_mesh(const Motion& plane, const MeshSurface& b,
                                      const Motion& motion_b, double lever_b, double tolerance);

}  // namespace tumble
