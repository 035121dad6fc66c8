#pragma once
#include "engine/collision/mesh_pairs/mesh_surface.hpp"
#include "engine/collision/shapes/convex_shape.hpp"

namespace tumble {

// Elements and features of shapes with flat faces, own frame: by the faces of a box or hull, or by
// the triangles of a mesh.

/// Shape::element_at().
SurfaceElement flat_element(const ConvexShape& shape, const Vec3& p, const Vec3& n);
SurfaceElement flat_element(const MeshSurface& surface, const Vec3& p, const Vec3& n);
/// Shape::border_at().
SurfaceElement flat_border(const ConvexShape& shape, const Vec3& p, const Vec3& n);
SurfaceElement flat_border(const MeshSurface& surface, const Vec3& p, const Vec3& n);
/// Shape::feature_at(); for a convex shape by its Voronoi planes, face 0 if it has none.
PolyhedronFeature flat_feature(const ConvexShape& shape, const Vec3& p, uint32_t triangle);
PolyhedronFeature flat_feature(const MeshSurface& surface, const Vec3& p, uint32_t triangle);
/// Whether there is a vertex at a point.
bool has_vertex(const MeshSurface& surface, const Vec3& p);

}  // namespace tumble
