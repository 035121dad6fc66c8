#include "engine/collision/shapes/outlines.hpp"

#include "engine/math/det/det.hpp"

#include <algorithm>
#include <utility>

namespace tumble {

void draw_arc(DebugDraw& out, const OutlineColour& colour, const Vec3& centre, const Vec3& u,
              const Vec3& v, double turn) {
  const int n = turn > 4 ? 32 : 16;
  Vec3 last = centre + u;
  for (int i = 1; i <= n; ++i) {
    const double angle = turn * i / n;
    const Vec3 next = centre + det::cos(angle) * u + det::sin(angle) * v;
    out.line(last, next, colour);
    last = next;
  }
}

void draw_ring(DebugDraw& out, const OutlineColour& colour, const Vec3& centre, const Vec3& u,
               const Vec3& v) {
  draw_arc(out, colour, centre, u, v, 2 * det::pi);
}

void draw_round_outline(DebugDraw& out, const OutlineColour& colour, double radius,
                        double half_height, bool caps) {
  const Vec3 x(radius, 0, 0), y(0, radius, 0), z(0, 0, radius), top(0, half_height, 0);
  draw_ring(out, colour, top, x, z);
  if (half_height > 0) draw_ring(out, colour, -top, x, z);
  for (const Vec3& side : {x, z, Vec3(-x), Vec3(-z)}) out.line(top + side, side - top, colour);
  if (!caps) return;
  for (const Vec3& side : {x, z}) {
    draw_arc(out, colour, top, side, y, det::pi);
    draw_arc(out, colour, -top, side, -y, det::pi);
  }
}

void draw_edges(DebugDraw& out, const OutlineColour& colour, const TriangleMesh& mesh) {
  std::vector<std::pair<uint32_t, uint32_t>> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles)
    for (size_t k = 0; k < 3; ++k) edges.push_back(std::minmax(t[k], t[(k + 1) % 3]));
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  for (const auto& [a, b] : edges) out.line(mesh.vertices[a], mesh.vertices[b], colour);
}

DrawnSurface drawn_mesh(const TriangleMesh& mesh) {
  DrawnSurface out;
  out.positions = mesh.vertices;
  out.indices.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles)
    out.indices.insert(out.indices.end(), t.begin(), t.end());
  return out;
}

}  // namespace tumble
