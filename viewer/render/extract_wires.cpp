#include "engine/collision/shape.hpp"
#include "engine/geometry/hull/convex_hull.hpp"
#include "viewer/render/extract.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tumble {
namespace {

/// Draws in the frame of one shape.
struct Wires {
  const Pose& pose;
  const Vec4f& colour;
  RenderScene& out;

  void line(const Vec3& a, const Vec3& b) const {
    out.lines.push_back({.a = pose.point(a).cast<float>(),
                         .b = pose.point(b).cast<float>(),
                         .colour = colour,
                         .width = 1});
  }
  /// An arc about `centre` from u towards v.
  void arc(const Vec3& centre, const Vec3& u, const Vec3& v, double turn = 2 * M_PI) const {
    const int n = turn > 4 ? 32 : 16;
    Vec3 last = centre + u;
    for (int i = 1; i <= n; ++i) {
      const double angle = turn * i / n;
      const Vec3 next = centre + std::cos(angle) * u + std::sin(angle) * v;
      line(last, next);
      last = next;
    }
  }
};

void box_wires(const Wires& w, const Vec3& h) {
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < 4; ++i) {
      Vec3 a = h;
      a[(axis + 1) % 3] *= i & 1 ? 1 : -1;
      a[(axis + 2) % 3] *= i & 2 ? 1 : -1;
      Vec3 b = a;
      b[axis] = -b[axis];
      w.line(a, b);
    }
}

void round_wires(const Wires& w, double radius, double half_height, bool caps) {
  const Vec3 x(radius, 0, 0), y(0, radius, 0), z(0, 0, radius), top(0, half_height, 0);
  w.arc(top, x, z);
  if (half_height > 0) w.arc(-top, x, z);
  for (const Vec3& side : {x, z, Vec3(-x), Vec3(-z)}) w.line(top + side, side - top);
  if (!caps) return;
  for (const Vec3& side : {x, z}) {
    w.arc(top, side, y, M_PI);
    w.arc(-top, side, -y, M_PI);
  }
}

/// Every edge once, those of only one triangle too.
void mesh_wires(const Wires& w, const TriangleMesh& mesh) {
  std::vector<std::pair<uint32_t, uint32_t>> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles)
    for (size_t k = 0; k < 3; ++k) edges.push_back(std::minmax(t[k], t[(k + 1) % 3]));
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  for (const auto& [a, b] : edges) w.line(mesh.vertices[a], mesh.vertices[b]);
}

}  // namespace

void add_wires(const Shape& shape, const Pose& pose, const Vec4f& colour, RenderScene& out) {
  const Wires w{pose, colour, out};
  const ShapeDef& def = shape.def();
  switch (shape.type()) {
    case ShapeType::sphere:
      round_wires(w, def.radius, 0, true);
      break;
    case ShapeType::capsule:
      round_wires(w, def.radius, 0.5 * def.height, true);
      break;
    case ShapeType::cylinder:
      round_wires(w, def.radius, 0.5 * def.height, false);
      break;
    case ShapeType::ellipsoid:
      for (int k = 0; k < 3; ++k)
        w.arc(Vec3::Zero(), def.half_extents[k] * Vec3::Unit(k),
              def.half_extents[(k + 1) % 3] * Vec3::Unit((k + 1) % 3));
      break;
    case ShapeType::box:
      box_wires(w, def.half_extents);
      break;
    case ShapeType::half_space:
      break;
    case ShapeType::triangle_mesh:
      if (def.mesh) mesh_wires(w, *def.mesh);
      break;
    case ShapeType::convex_hull:
      if (!def.mesh) break;
      if (const auto hull = convex_hull(def.mesh->vertices))
        for (const PolyhedronEdge& e : hull->polyhedron.edges)
          w.line(hull->polyhedron.vertices[e.vertices[0]],
                 hull->polyhedron.vertices[e.vertices[1]]);
      break;
  }
}

}  // namespace tumble
