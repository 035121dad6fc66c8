#pragma once
#include "engine/collision/polyhedron_feature.hpp"
#include "engine/collision/shape.hpp"

namespace tumble {

/// The feature of a shape on which a point of its surface lies (`p` in the shape's frame, up to
/// 1e-9 of the size), the one of lowest dimension:
/// - boxes and hulls: a vertex, edge or face of their ConvexPolyhedron;
/// - meshes: a vertex of the mesh, an edge of its MeshTopology, or `triangle`;
/// - balls: vertex 0, the centre; capsules: vertex 0 below and 1 above, or edge 0 between them;
/// - cylinders: face 0 below, 1 above, 2 around; edges 0 and 1, the rims below and above;
/// - ellipsoids and half-spaces: face 0.
PolyhedronFeature contact_feature(const Shape& shape, const Vec3& p, uint32_t triangle);

}  // namespace tumble
