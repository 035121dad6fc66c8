#pragma once
#include "engine/core/result.hpp"
#include "engine/math/types.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tumble {

/// Three indices into TriangleMesh::vertices, counter-clockwise seen from outside.
using Triangle = std::array<uint32_t, 3>;
/// "There is none", for indices of vertices, edges and faces.
constexpr uint32_t no_index = 0xffffffffu;

/// An indexed triangle mesh in its own frame; nothing is promised about it before validate().
struct TriangleMesh {
  std::vector<Vec3> vertices;  ///< [m]
  std::vector<Triangle> triangles;

  const Vec3& corner(size_t triangle, size_t k) const { return vertices[triangles[triangle][k]]; }
};

struct MeshLimits {
  size_t max_vertices = 20'000'000;
  size_t max_triangles = 20'000'000;
  double max_coordinate = 1e9;  ///< largest |coordinate| [m]
};

/// Ok when there is at least one triangle, every coordinate is finite and within the limits and
/// every index is in range. Says nothing about closedness (mesh_topology) or volume
/// (mass_properties).
Status validate(const TriangleMesh& mesh, const MeshLimits& limits = {});

/// Smallest box around the vertices; empty for a mesh without vertices.
Aabb bounds(const TriangleMesh& mesh);
/// Smallest box around one triangle.
Aabb triangle_bounds(const TriangleMesh& mesh, size_t triangle);
/// Half the cross product of two edges: direction of the normal, length of the area [m^2].
Vec3 face_area_vector(const TriangleMesh& mesh, size_t triangle);
/// Outward unit normal; the zero vector for a triangle without area.
Vec3 face_normal(const TriangleMesh& mesh, size_t triangle);
/// Sum of the triangles' areas [m^2].
double surface_area(const TriangleMesh& mesh);

/// Every vertex mapped by `pose`.
TriangleMesh transformed(const TriangleMesh& mesh, const Pose& pose);
/// Every vertex multiplied by `scale`, component by component; an odd number of negative factors
/// also turns the triangles, so that outside stays outside.
TriangleMesh scaled(const TriangleMesh& mesh, const Vec3& scale);
/// Adds the vertices and triangles of `part` to `mesh`.
void append(TriangleMesh& mesh, const TriangleMesh& part);
/// Swaps the orientation of every triangle.
void flip(TriangleMesh& mesh);

}  // namespace tumble
