#pragma once
#include "engine/geometry/triangle_mesh.hpp"

#include <functional>

/// Meshes from formulas: closed, outward, about the origin, for tests, benchmarks, drawing.
namespace tumble::make_mesh {

/// Eight vertices, twelve triangles.
TriangleMesh box(const Vec3& half_extents);
/// Regular, with all corners at distance `radius`.
TriangleMesh tetrahedron(double radius);
/// 20 * 4^levels triangles with every vertex on the sphere.
TriangleMesh icosphere(double radius, int levels);
/// Around the Y axis; `major` from the centre to the tube's middle, `minor` the tube's radius.
/// 2 * major_segments * minor_segments triangles.
TriangleMesh torus(double major, double minor, int major_segments, int minor_segments);
/// Prism with a regular polygon of `segments` corners inscribed in the circle, along Y.
TriangleMesh cylinder(double half_height, double radius, int segments);
/// Along Y; `half_height` is half the length of the axis segment; `rings` per half sphere.
TriangleMesh capsule(double half_height, double radius, int segments, int rings);
/// Open height field over [-size/2, size/2]^2 in x and z, facing +Y, `cells` by `cells` squares of
/// two triangles each.
TriangleMesh terrain(double size, int cells, const std::function<double(double, double)>& height);

/// Volume of the torus polyhedron: both polygons inscribed (Pappus for the discrete solid).
double torus_volume(double major, double minor, int major_segments, int minor_segments);
double cylinder_volume(double half_height, double radius, int segments);

}  // namespace tumble::make_mesh
