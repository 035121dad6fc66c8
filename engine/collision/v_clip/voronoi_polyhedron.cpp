#include "engine/collision/v_clip/voronoi_polyhedron.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

Error voronoi_fault(std::string message) {
  return Error{ErrorCode::invalid_argument, "V-Clip: " + std::move(message), {}, {}};
}

/// Two adjacent faces may rise over each other by this share of the radius: hulls merge facets.
constexpr double convexity_tolerance = 1e-6;

Status add_edges(const ConvexPolyhedron& p, VoronoiPolyhedron& out) {
  for (const PolyhedronEdge& e : p.edges) {
    VoronoiEdge edge;
    edge.vertices = e.vertices;
    edge.faces = e.faces;
    edge.tail = p.vertices[e.vertices[0]];
    const Vec3 along = p.vertices[e.vertices[1]] - edge.tail;
    edge.length = along.stableNorm();
    if (!(edge.length > 0)) {
      return voronoi_fault(fmt::format("edge {}-{} has no length", e.vertices[0], e.vertices[1]));
    }
    edge.direction = along / edge.length;
    for (size_t k = 0; k < 2; ++k) {
      const Vec3 across = p.planes[e.faces[k]].normal.cross(edge.direction);
      edge.into_face[k] = (k == 0 ? across : Vec3(-across)).normalized();
    }
    out.edges.push_back(edge);
  }
  return {};
}

void add_spokes(const ConvexPolyhedron& p, VoronoiPolyhedron& out) {
  out.spoke_first.assign(p.vertices.size() + 1, 0);
  for (const PolyhedronEdge& e : p.edges)
    for (uint32_t v : e.vertices) ++out.spoke_first[v + 1];
  for (size_t v = 0; v < p.vertices.size(); ++v) out.spoke_first[v + 1] += out.spoke_first[v];
  out.spokes.resize(out.spoke_first.back());
  std::vector<uint32_t> cursor(out.spoke_first.begin(), out.spoke_first.end() - 1);
  for (uint32_t i = 0; i < out.edges.size(); ++i) {
    const VoronoiEdge& e = out.edges[i];
    out.spokes[cursor[e.vertices[0]]++] = {e.direction, e.length, i, e.vertices[1]};
    out.spokes[cursor[e.vertices[1]]++] = {-e.direction, e.length, i, e.vertices[0]};
  }
}

uint32_t edge_between(const ConvexPolyhedron& p, uint32_t a, uint32_t b) {
  const std::array<uint32_t, 2> key{std::min(a, b), std::max(a, b)};
  const auto before = [](const PolyhedronEdge& e, const std::array<uint32_t, 2>& k) {
    return e.vertices < k;
  };
  return uint32_t(std::lower_bound(p.edges.begin(), p.edges.end(), key, before) - p.edges.begin());
}

void add_faces(const ConvexPolyhedron& p, VoronoiPolyhedron& out) {
  for (uint32_t f = 0; f < p.face_count(); ++f) {
    const auto loop = p.face(f);
    out.faces.push_back({p.planes[f].normal, p.planes[f].offset, uint32_t(out.sides.size()),
                         uint32_t(loop.size())});
    for (size_t k = 0; k < loop.size(); ++k) {
      const uint32_t a = loop[k], b = loop[(k + 1) % loop.size()];
      const uint32_t e = edge_between(p, a, b);
      const VoronoiEdge& edge = out.edges[e];
      const Vec3& inward = edge.into_face[edge.faces[0] == f ? 0 : 1];
      out.sides.push_back({inward, inward.dot(p.vertices[a]), e});
      out.flatness = std::max(out.flatness, std::abs(p.planes[f].distance(p.vertices[a])));
      const Vec3 back = p.vertices[a] - p.vertices[loop[(k + loop.size() - 1) % loop.size()]];
      const Vec3 on = p.vertices[b] - p.vertices[a];
      if (back.dot(on) > 0) {  // an obtuse corner
        const double sine = back.normalized().cross(on.normalized()).norm();
        out.least_corner_sine = std::min(out.least_corner_sine, sine);
      }
    }
  }
}

/// Checks that no face rises over a neighbour: for a closed surface this is convexity.
Status check_convex(const ConvexPolyhedron& p, const VoronoiPolyhedron& v) {
  for (const VoronoiEdge& e : v.edges) {
    for (size_t k = 0; k < 2; ++k) {
      for (uint32_t corner : p.face(e.faces[1 - k])) {
        if (p.planes[e.faces[k]].distance(p.vertices[corner]) > convexity_tolerance * v.radius) {
          return voronoi_fault(fmt::format("faces {} and {} do not meet convexly at edge {}-{}",
                                           e.faces[0], e.faces[1], e.vertices[0], e.vertices[1]));
        }
      }
    }
  }
  return {};
}

}  // namespace

Result<VoronoiPolyhedron> make_voronoi_polyhedron(const ConvexPolyhedron& polyhedron) {
  VoronoiPolyhedron out;
  out.vertices = polyhedron.vertices;
  for (const Vec3& v : out.vertices) {
    if (!v.allFinite()) return voronoi_fault("a vertex is not finite");
    out.centre += v / double(out.vertices.size());
  }
  for (const Vec3& v : out.vertices) out.radius = std::max(out.radius, (v - out.centre).norm());
  for (size_t f = 0; f < polyhedron.face_count(); ++f) {
    const Plane& plane = polyhedron.planes[f];
    if (!(std::abs(plane.normal.squaredNorm() - 1) < 1e-9) || !std::isfinite(plane.offset)) {
      return voronoi_fault(fmt::format("face {} has no plane", f));
    }
  }
  out.inner_radius = out.radius;
  for (const Plane& plane : polyhedron.planes)
    out.inner_radius = std::min(out.inner_radius, -plane.distance(out.centre));
  if (const Status ok = add_edges(polyhedron, out); !ok) return ok.error();
  add_spokes(polyhedron, out);
  add_faces(polyhedron, out);
  if (const Status ok = check_convex(polyhedron, out); !ok) return ok.error();
  for (unsigned k = 0; k < 8; ++k) {
    const Vec3 d(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
    out.octant_start[k] = support_vertex(polyhedron, d);
  }
  return out;
}

uint32_t climb(const VoronoiPolyhedron& polyhedron, const Vec3& direction) {
  const unsigned octant = unsigned(direction.x() > 0) + 2 * unsigned(direction.y() > 0) +
                          4 * unsigned(direction.z() > 0);
  uint32_t best = polyhedron.octant_start[octant];
  double height = direction.dot(polyhedron.vertices[best]);
  for (bool climbed = true; climbed;) {
    climbed = false;
    const uint32_t from = best;
    for (const VoronoiSpoke& s : polyhedron.spokes_of(from)) {
      const double h = direction.dot(polyhedron.vertices[s.other]);
      if (h > height) {
        height = h;
        best = s.other;
        climbed = true;
      }
    }
  }
  return best;
}

}  // namespace tumble
