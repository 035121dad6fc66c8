#pragma once
#include "engine/geometry/constructions/projections.hpp"
#include "engine/geometry/triangle_mesh.hpp"

#include <span>

namespace tumble {

/// An edge of a convex polyhedron: faces[0] runs vertices[0] -> vertices[1], faces[1] back.
struct PolyhedronEdge {
  std::array<uint32_t, 2> vertices;  ///< ascending
  std::array<uint32_t, 2> faces;
};

/// A convex polyhedron with merged (polygonal) facets.
///
/// Half-edge h is the place h in `face_vertices`: it starts at vertex face_vertices[h], belongs to
/// face half_edge_face[h], and half_edge_twin[h] is its opposite; half-edges of face f are
/// face_first[f] .. face_first[f + 1] - 1 in counter-clockwise order seen from outside.
struct ConvexPolyhedron {
  std::vector<Vec3> vertices;
  std::vector<uint32_t> face_first;     ///< size faces + 1
  std::vector<uint32_t> face_vertices;  ///< the loops, one after the other
  std::vector<Plane> planes;            ///< of the faces, outward
  std::vector<uint32_t> half_edge_twin;
  std::vector<uint32_t> half_edge_face;
  std::vector<PolyhedronEdge> edges;      ///< sorted by vertices
  std::vector<uint32_t> neighbour_first;  ///< size vertices + 1
  std::vector<uint32_t> neighbours;       ///< vertices joined to each vertex by an edge, ascending

  size_t face_count() const { return planes.size(); }
  std::span<const uint32_t> face(size_t f) const {
    return {face_vertices.data() + face_first[f], face_first[f + 1] - face_first[f]};
  }
  std::span<const uint32_t> neighbours_of(uint32_t v) const {
    return {neighbours.data() + neighbour_first[v], neighbour_first[v + 1] - neighbour_first[v]};
  }
  /// The half-edge that follows h around its face.
  uint32_t next(uint32_t h) const {
    const uint32_t f = half_edge_face[h];
    return h + 1 == face_first[f + 1] ? face_first[f] : h + 1;
  }
};

/// Builds planes, twins, edges and adjacency from vertices and face loops (counter-clockwise seen
/// from outside). Error when the loops do not form a closed surface.
Result<ConvexPolyhedron> make_polyhedron(std::vector<Vec3> vertices,
                                         std::vector<std::vector<uint32_t>> loops);
/// The same from loops that stand one after the other, with their planes.
Result<ConvexPolyhedron> make_polyhedron(std::vector<Vec3> vertices,
                                         std::vector<uint32_t> face_first,
                                         std::vector<uint32_t> face_vertices,
                                         std::vector<Plane> planes);

/// Whether a loop of points turns left at every corner, seen from where `normal` points, and winds
/// once.
bool turns_left(std::span<const Vec3> points, std::span<const uint32_t> loop, const Vec3& normal);
/// Whether every corner of such a loop lies on the left of every side's line, up to `epsilon` [m].
/// Tries turns_left first; else the cost is the square of the corners.
bool is_convex_loop(std::span<const Vec3> points, std::span<const uint32_t> loop,
                    const Vec3& normal, double epsilon);

/// The faces cut into fans of triangles.
TriangleMesh to_mesh(const ConvexPolyhedron& polyhedron);

/// The vertex furthest along `direction`; ties go to the lowest number. Brute force over all.
uint32_t support_vertex(const ConvexPolyhedron& polyhedron, const Vec3& direction);
/// The same height (up to rounding, 1e-14 of the size) by climbing from `start` along edges:
/// near constant time when `start` is a recent answer.
uint32_t support_vertex_from(const ConvexPolyhedron& polyhedron, const Vec3& direction,
                             uint32_t start);

}  // namespace tumble
