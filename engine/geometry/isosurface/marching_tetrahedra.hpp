#pragma once
#include "engine/geometry/isosurface/sparse_field.hpp"
#include "engine/geometry/triangle_mesh.hpp"

namespace tumble {

/// The surface that separates the nodes where a field is negative from the others; triangles are
/// counter-clockwise seen from the side that is not negative. Marching tetrahedra (Doi and Koide,
/// "An efficient method of triangulating equi-valued surfaces by using tetrahedral cells", 1991) on
/// Kuhn's division of every cube into the six tetrahedra around its diagonal, which match across
/// faces. A tetrahedron has no ambiguous case.
///
/// For every input the mesh is a closed oriented 2-manifold: every edge has two triangles that run
/// it in opposite directions, and the triangles about a vertex form one fan. Vertices stand where
/// the field, linear along the edges, is 0, but never within a millionth of an edge of a node, so
/// that no triangle has coinciding corners. Empty for a field that is negative nowhere. Vertices
/// and triangles are in the order of the grid. Empty when stopped, too (engine/core/stop.hpp).
TriangleMesh isosurface(const SparseField& field);

}  // namespace tumble
