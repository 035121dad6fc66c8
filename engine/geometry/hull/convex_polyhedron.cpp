#include "engine/geometry/hull/convex_polyhedron.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Newell's normal of a loop and the lowest plane across it that has the whole loop inside.
Plane plane_of(const std::vector<Vec3>& vertices, std::span<const uint32_t> loop) {
  const Vec3& origin = vertices[loop[0]];
  Vec3 n = Vec3::Zero();
  for (size_t k = 1; k + 1 < loop.size(); ++k) {
    n += (vertices[loop[k]] - origin).cross(vertices[loop[k + 1]] - origin);
  }
  const double length = n.norm();
  if (length > 0) n /= length;
  double offset = n.dot(origin);
  for (uint32_t v : loop) offset = std::max(offset, n.dot(vertices[v]));
  return {n, offset};
}

struct DirectedSide {
  uint32_t low, high;
  bool forward;
  uint32_t half_edge;
};

Status link_half_edges(ConvexPolyhedron& p) {
  std::vector<DirectedSide> sides;
  sides.reserve(p.face_vertices.size());
  for (uint32_t h = 0; h < p.face_vertices.size(); ++h) {
    const uint32_t a = p.face_vertices[h], b = p.face_vertices[p.next(h)];
    sides.push_back({std::min(a, b), std::max(a, b), a < b, h});
  }
  std::sort(sides.begin(), sides.end(), [](const DirectedSide& x, const DirectedSide& y) {
    if (x.low != y.low) return x.low < y.low;
    return x.high != y.high ? x.high < y.high : x.forward > y.forward;
  });
  p.half_edge_twin.assign(p.face_vertices.size(), no_index);
  for (size_t i = 0; i < sides.size(); i += 2) {
    const bool paired = i + 1 < sides.size() && sides[i].low == sides[i + 1].low &&
                        sides[i].high == sides[i + 1].high && sides[i].forward &&
                        !sides[i + 1].forward &&
                        (i + 2 == sides.size() || sides[i].low != sides[i + 2].low ||
                         sides[i].high != sides[i + 2].high);
    if (!paired) {
      return Error{ErrorCode::invalid_argument,
                   fmt::format("the faces do not meet two by two at edge {}-{}", sides[i].low,
                               sides[i].high),
                   {},
                   {}};
    }
    const uint32_t h = sides[i].half_edge, twin = sides[i + 1].half_edge;
    p.half_edge_twin[h] = twin;
    p.half_edge_twin[twin] = h;
    p.edges.push_back(
        {{sides[i].low, sides[i].high}, {p.half_edge_face[h], p.half_edge_face[twin]}});
  }
  return {};
}

void link_neighbours(ConvexPolyhedron& p) {
  p.neighbour_first.assign(p.vertices.size() + 1, 0);
  for (const PolyhedronEdge& e : p.edges) {
    ++p.neighbour_first[e.vertices[0] + 1];
    ++p.neighbour_first[e.vertices[1] + 1];
  }
  for (size_t v = 0; v < p.vertices.size(); ++v) p.neighbour_first[v + 1] += p.neighbour_first[v];
  p.neighbours.assign(p.neighbour_first.back(), 0);
  std::vector<uint32_t> cursor(p.neighbour_first.begin(), p.neighbour_first.end() - 1);
  // Edges come sorted by (low, high): the lower neighbours of a vertex first, then the higher.
  for (const PolyhedronEdge& e : p.edges) p.neighbours[cursor[e.vertices[1]]++] = e.vertices[0];
  for (const PolyhedronEdge& e : p.edges) p.neighbours[cursor[e.vertices[0]]++] = e.vertices[1];
}

}  // namespace

Result<ConvexPolyhedron> make_polyhedron(std::vector<Vec3> vertices,
                                         std::vector<std::vector<uint32_t>> loops) {
  const auto fault = [](std::string m) {
    return Error{ErrorCode::invalid_argument, std::move(m), {}, {}};
  };
  ConvexPolyhedron p;
  p.vertices = std::move(vertices);
  if (loops.size() < 4) return fault(fmt::format("{} faces are no polyhedron", loops.size()));
  p.face_first.push_back(0);
  for (size_t f = 0; f < loops.size(); ++f) {
    if (loops[f].size() < 3) {
      return fault(fmt::format("face {} has only {} corners", f, loops[f].size()));
    }
    for (uint32_t v : loops[f]) {
      if (v >= p.vertices.size()) {
        return fault(fmt::format("face {} refers to vertex {} of {}", f, v, p.vertices.size()));
      }
      p.face_vertices.push_back(v);
      p.half_edge_face.push_back(uint32_t(f));
    }
    p.face_first.push_back(uint32_t(p.face_vertices.size()));
    p.planes.push_back(plane_of(p.vertices, loops[f]));
  }
  if (const Status ok = link_half_edges(p); !ok) return ok.error();
  link_neighbours(p);
  return p;
}

TriangleMesh to_mesh(const ConvexPolyhedron& polyhedron) {
  TriangleMesh mesh;
  mesh.vertices = polyhedron.vertices;
  for (size_t f = 0; f < polyhedron.face_count(); ++f) {
    const auto loop = polyhedron.face(f);
    for (size_t k = 1; k + 1 < loop.size(); ++k) {
      mesh.triangles.push_back({loop[0], loop[k], loop[k + 1]});
    }
  }
  return mesh;
}

uint32_t support_vertex(const ConvexPolyhedron& polyhedron, const Vec3& direction) {
  uint32_t best = 0;
  double height = -std::numeric_limits<double>::infinity();
  for (uint32_t v = 0; v < polyhedron.vertices.size(); ++v) {
    const double h = direction.dot(polyhedron.vertices[v]);
    if (h > height) {
      height = h;
      best = v;
    }
  }
  return best;
}

uint32_t support_vertex_from(const ConvexPolyhedron& polyhedron, const Vec3& direction,
                             uint32_t start) {
  uint32_t best = start;
  double height = direction.dot(polyhedron.vertices[best]);
  for (bool climbed = true; climbed;) {
    climbed = false;
    const uint32_t from = best;
    for (uint32_t v : polyhedron.neighbours_of(from)) {
      const double h = direction.dot(polyhedron.vertices[v]);
      if (h > height) {
        height = h;
        best = v;
        climbed = true;
      }
    }
  }
  return best;
}

}  // namespace tumble
