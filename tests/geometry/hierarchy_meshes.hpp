#pragma once
#include "engine/geometry/hierarchy/hierarchy.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "tests/geometry/draws.hpp"

#include <cmath>
#include <memory>

/// Meshes that hierarchies find hard, by name.
namespace tumble::hard_meshes {

using MeshPtr = std::shared_ptr<const TriangleMesh>;

inline MeshPtr share(TriangleMesh mesh) {
  return std::make_shared<const TriangleMesh>(std::move(mesh));
}

inline TriangleMesh soup(Random& r, int n, double size) {
  TriangleMesh m;
  for (int i = 0; i < n; ++i) {
    const Vec3 centre = draws::in_box(r, 1);
    for (const Vec3& c : draws::triangle(r, size)) m.vertices.push_back(centre + c);
    const auto k = uint32_t(3 * i);
    m.triangles.push_back({k, k + 1, k + 2});
  }
  return m;
}

/// Needles: two corners together, the third far, all directions.
inline TriangleMesh slivers(Random& r, int n) {
  TriangleMesh m;
  for (int i = 0; i < n; ++i) {
    const Vec3 a = draws::in_box(r, 1), b = a + 1e-9 * draws::direction(r);
    for (const Vec3& c : {a, b, Vec3(a + draws::direction(r))}) m.vertices.push_back(c);
    const auto k = uint32_t(3 * i);
    m.triangles.push_back({k, k + 1, k + 2});
  }
  return m;
}

struct Family {
  const char* name;
  MeshPtr mesh;
};

inline std::vector<Family> families() {
  Random r(70);
  std::vector<Family> out;
  out.push_back({"torus", share(make_mesh::torus(1, 0.4, 16, 8))});
  out.push_back({"one triangle", share(soup(r, 1, 1))});
  out.push_back({"soup of small", share(soup(r, 200, 0.1))});
  out.push_back({"soup of large", share(soup(r, 100, 2))});
  out.push_back({"slivers", share(slivers(r, 80))});
  TriangleMesh same;
  for (int i = 0; i < 60; ++i) append(same, make_mesh::tetrahedron(1));
  out.push_back({"coincident", share(std::move(same))});
  out.push_back(
      {"flat grid", share(make_mesh::terrain(2, 12, [](double, double) { return 0.25; }))});
  out.push_back({"triangles that are points", share(soup(r, 50, 0))});
  TriangleMesh scales;  // sizes and places over thirty powers of two
  for (int i = 0; i < 60; ++i) {
    const double s = std::ldexp(1.0, -i / 2);
    append(scales, transformed(scaled(make_mesh::tetrahedron(1), Vec3::Constant(0.3 * s)),
                               {Vec3(s, 0, 0), Quat::Identity()}));
  }
  out.push_back({"geometric series", share(std::move(scales))});
  out.push_back({"far away", share(transformed(make_mesh::icosphere(1, 2),
                                               {Vec3(1e5, 2e5, -3e5), Quat::Identity()}))});
  return out;
}

}  // namespace tumble::hard_meshes
