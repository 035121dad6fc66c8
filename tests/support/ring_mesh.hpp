#pragma once
#include "engine/geometry/triangle_mesh.hpp"

#include <cmath>

namespace tumble {

/// A torus about y of 2 * around * across triangles, for tests that also see the meshes of the
/// renderer (whose make_mesh is another one).
inline TriangleMesh ring_mesh(double radius, double thickness, uint32_t around, uint32_t across) {
  TriangleMesh mesh;
  for (uint32_t i = 0; i < around; ++i)
    for (uint32_t k = 0; k < across; ++k) {
      const double a = 2 * M_PI * i / around, b = 2 * M_PI * k / across;
      const double r = radius + thickness * std::cos(b);
      mesh.vertices.push_back({r * std::cos(a), thickness * std::sin(b), -r * std::sin(a)});
      const uint32_t i1 = (i + 1) % around, k1 = (k + 1) % across;
      const uint32_t p = i * across + k, q = i1 * across + k, s = i1 * across + k1,
                     t = i * across + k1;
      mesh.triangles.push_back({p, q, s});
      mesh.triangles.push_back({p, s, t});
    }
  return mesh;
}

}  // namespace tumble
