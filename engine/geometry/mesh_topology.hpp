#pragma once
#include "engine/geometry/triangle_mesh.hpp"

#include <span>

namespace tumble {

/// How the surface bends at an edge, seen from outside.
enum class EdgeBend : uint8_t {
  convex,   ///< a ridge
  flat,     ///< the faces are coplanar within the tolerance
  concave,  ///< a valley
  open,     ///< fewer or more than two faces, or two that run the same way
};

/// An edge of a mesh with the faces beside it.
struct MeshEdge {
  std::array<uint32_t, 2> vertices{no_index, no_index};  ///< ascending
  /// The first two faces by number; no_index where there is none. In a consistently oriented mesh
  /// one of them runs vertices[0] -> vertices[1], the other back.
  std::array<uint32_t, 2> faces{no_index, no_index};
  uint32_t face_count = 0;  ///< 1: open edge; 2: manifold; more: non-manifold
  EdgeBend bend = EdgeBend::open;
  /// Pseudo-normal of the edge: normalised sum of the normals of its faces.
  Vec3 normal = Vec3::Zero();
};

/// What is next to what in a triangle mesh, and its pseudo-normals.
/// Baerentzen & Aanaes, "Signed distance computation using the angle weighted pseudonormal"
/// (2005): the sign of (p - closest).dot(normal of the closest feature) is the sign of the
/// distance.
struct MeshTopology {
  std::vector<MeshEdge> edges;              ///< sorted by (vertices[0], vertices[1])
  std::vector<Triangle> face_edges;         ///< edge k runs between corners k and k + 1
  std::vector<Vec3> face_normals;           ///< unit, zero for faces without area
  std::vector<Vec3> vertex_normals;         ///< angle-weighted, unit; zero for unused vertices
  std::vector<uint32_t> vertex_face_first;  ///< size vertices + 1, into vertex_faces
  std::vector<uint32_t> vertex_faces;       ///< ascending for each vertex
  std::vector<uint32_t> vertex_edge_first;  ///< size vertices + 1, into vertex_edges
  std::vector<uint32_t> vertex_edges;       ///< ascending for each vertex

  size_t open_edges = 0;          ///< with one face
  size_t non_manifold_edges = 0;  ///< with more than two faces
  size_t misoriented_edges = 0;   ///< with two faces that run the same way
  size_t used_vertices = 0;       ///< that some triangle refers to
  /// V - E + F over used vertices: 2 for a ball, 0 for a torus, 2 (1 - g) per closed part.
  int64_t euler_characteristic = 0;

  /// Every edge has exactly two faces.
  bool closed() const { return open_edges == 0 && non_manifold_edges == 0; }
  /// Closed, and the two faces of every edge run in opposite directions.
  bool closed_and_oriented() const { return closed() && misoriented_edges == 0; }

  std::span<const uint32_t> faces_of_vertex(uint32_t v) const {
    return {vertex_faces.data() + vertex_face_first[v],
            vertex_face_first[v + 1] - vertex_face_first[v]};
  }
  std::span<const uint32_t> edges_of_vertex(uint32_t v) const {
    return {vertex_edges.data() + vertex_edge_first[v],
            vertex_edge_first[v + 1] - vertex_edge_first[v]};
  }
};

/// Builds the topology of a mesh that passed validate(). Triangles that use a vertex twice have no
/// area and no edges of length zero: the edge from a vertex to itself is left out (no_index in
/// face_edges). `flat_sine` is the sine of the dihedral angle below which an edge counts as flat.
MeshTopology build_topology(const TriangleMesh& mesh, double flat_sine = 1e-9);

}  // namespace tumble
