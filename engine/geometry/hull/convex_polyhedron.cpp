#include "engine/geometry/hull/convex_polyhedron.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tumble {
namespace {

/// The plane with Newell's normal of a loop, moved outwards until the whole loop is on its inner
/// side.
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
  uint32_t high;
  bool backward;  // from the higher vertex to the lower
  uint32_t half_edge;
};

Status link_half_edges(ConvexPolyhedron& p) {
  // Sides are grouped by their lower vertex, a few for each.
  const auto sides = uint32_t(p.face_vertices.size());
  const auto ends = [&p](uint32_t h) {
    return std::pair(p.face_vertices[h], p.face_vertices[p.next(h)]);
  };
  std::vector<uint32_t> first(p.vertices.size() + 2, 0);
  for (uint32_t h = 0; h < sides; ++h) {
    const auto [a, b] = ends(h);
    ++first[std::min(a, b) + 2];
  }
  for (size_t v = 2; v < first.size(); ++v) first[v] += first[v - 1];
  std::vector<DirectedSide> at(sides);
  for (uint32_t h = 0; h < sides; ++h) {
    const auto [a, b] = ends(h);
    at[first[std::min(a, b) + 1]++] = {std::max(a, b), a > b, h};
  }
  p.half_edge_twin.assign(sides, no_index);
  p.edges.reserve(sides / 2);
  for (uint32_t low = 0; low < p.vertices.size(); ++low) {
    const auto begin = at.begin() + first[low], end = at.begin() + first[low + 1];
    std::sort(begin, end, [](const DirectedSide& x, const DirectedSide& y) {
      return x.high != y.high ? x.high < y.high : x.backward < y.backward;
    });
    for (auto s = begin; s < end; s += 2) {
      const bool paired = end - s >= 2 && s[0].high == s[1].high && !s[0].backward &&
                          s[1].backward && (end - s == 2 || s[2].high != s[0].high);
      if (!paired) {
        return Error{ErrorCode::invalid_argument,
                     fmt::format("the faces do not meet two by two at edge {}-{}", low, s->high),
                     {},
                     {}};
      }
      const uint32_t h = s[0].half_edge, twin = s[1].half_edge;
      p.half_edge_twin[h] = twin;
      p.half_edge_twin[twin] = h;
      p.edges.push_back({{low, s->high}, {p.half_edge_face[h], p.half_edge_face[twin]}});
    }
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
  // Edges are sorted by (low, high): a vertex gets its lower neighbours first, then the higher
  // ones.
  for (const PolyhedronEdge& e : p.edges) p.neighbours[cursor[e.vertices[1]]++] = e.vertices[0];
  for (const PolyhedronEdge& e : p.edges) p.neighbours[cursor[e.vertices[0]]++] = e.vertices[1];
}

}  // namespace

Result<ConvexPolyhedron> make_polyhedron(std::vector<Vec3> vertices,
                                         std::vector<std::vector<uint32_t>> loops) {
  std::vector<uint32_t> first{0}, corners;
  for (const auto& loop : loops) {
    corners.insert(corners.end(), loop.begin(), loop.end());
    first.push_back(uint32_t(corners.size()));
  }
  const auto in_range = [&](uint32_t v) { return v < vertices.size(); };
  std::vector<Plane> planes(loops.size());
  if (std::all_of(corners.begin(), corners.end(), in_range)) {
    for (size_t f = 0; f < loops.size(); ++f) {
      if (!loops[f].empty()) planes[f] = plane_of(vertices, loops[f]);
    }
  }
  return make_polyhedron(std::move(vertices), std::move(first), std::move(corners),
                         std::move(planes));
}

Result<ConvexPolyhedron> make_polyhedron(std::vector<Vec3> vertices,
                                         std::vector<uint32_t> face_first,
                                         std::vector<uint32_t> face_vertices,
                                         std::vector<Plane> planes) {
  const auto fault = [](std::string m) {
    return Error{ErrorCode::invalid_argument, std::move(m), {}, {}};
  };
  ConvexPolyhedron p;
  p.vertices = std::move(vertices);
  p.face_first = std::move(face_first);
  p.face_vertices = std::move(face_vertices);
  p.planes = std::move(planes);
  if (p.face_count() < 4) return fault(fmt::format("{} faces are no polyhedron", p.face_count()));
  p.half_edge_face.reserve(p.face_vertices.size());
  for (size_t f = 0; f < p.face_count(); ++f) {
    const auto loop = p.face(f);
    if (loop.size() < 3) return fault(fmt::format("face {} has only {} corners", f, loop.size()));
    for (uint32_t v : loop) {
      if (v >= p.vertices.size()) {
        return fault(fmt::format("face {} refers to vertex {} of {}", f, v, p.vertices.size()));
      }
    }
    p.half_edge_face.insert(p.half_edge_face.end(), loop.size(), uint32_t(f));
  }
  if (const Status ok = link_half_edges(p); !ok) return ok.error();
  link_neighbours(p);
  return p;
}

bool turns_left(std::span<const Vec3> points, std::span<const uint32_t> loop, const Vec3& normal) {
  const size_t n = loop.size();
  const auto left = [&](uint32_t a, uint32_t b, uint32_t c) {
    return normal.dot((points[b] - points[a]).cross(points[c] - points[b])) > 0;
  };
  for (size_t k = 0; k < n; ++k) {
    const uint32_t b = loop[(k + 1) % n], c = loop[(k + 2) % n];
    if (!left(loop[k], b, c)) return false;
    // Checks all triangles of the fan around the first corner, which rejects loops that wind more
    // than once.
    if (k + 2 < n && !left(loop[0], b, c)) return false;
  }
  return true;
}

bool is_convex_loop(std::span<const Vec3> points, std::span<const uint32_t> loop,
                    const Vec3& normal, double epsilon) {
  if (turns_left(points, loop, normal)) return true;
  for (size_t k = 0; k < loop.size(); ++k) {
    const Vec3& a = points[loop[k]];
    const Vec3 inward = normal.cross(points[loop[(k + 1) % loop.size()]] - a).normalized();
    for (uint32_t v : loop) {
      if (inward.dot(points[v] - a) < -epsilon) return false;
    }
  }
  return true;
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
