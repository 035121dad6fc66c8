#pragma once
#include "engine/collision/mesh_pairs/mesh_surface.hpp"
#include "engine/collision/shapes/convex_shape.hpp"

#include <optional>

namespace tumble {

// What shapes with flat faces answer about their surface; own frame.

/// Shape::element_at() of a box or hull.
SurfaceElement flat_element(const ConvexShape& shape, const Vec3& p, const Vec3& n);
/// Shape::border_at() of a box or hull.
SurfaceElement flat_border(const ConvexShape& shape, const Vec3& p, const Vec3& n);
/// Of a mesh; `flat`: a face across `n` is wanted.
SurfaceElement mesh_element(const MeshSurface& surface, const Vec3& p, const Vec3& n, bool flat);
/// Whether there is a vertex at a point.
bool has_vertex(const MeshSurface& surface, const Vec3& p);

/// Shape::feature_at() by the planes of a polyhedron; face 0 where there are none.
PolyhedronFeature feature_on_polyhedron(const VoronoiPolyhedron* polyhedron, const Vec3& p);
PolyhedronFeature feature_on_mesh(const MeshSurface& surface, const Vec3& p, uint32_t triangle);

}  // namespace tumble
