#include "engine/geometry/mesh_orientation.hpp"

#include "engine/geometry/mesh_cleanup.hpp"
#include "engine/geometry/mesh_topology.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tumble {
namespace {

constexpr size_t most_outer_parts = 256;

struct ConnectedPart {
  std::vector<uint32_t> triangles;
  std::vector<uint8_t> turned;  // of each triangle, relative to the first one
  bool orientable = true;
  bool closed = true;
  double volume6 = 0;
  Aabb box;
};

/// Whether face `f` runs from the lower to the higher vertex of edge `e`.
bool runs_forward(const TriangleMesh& mesh, const MeshTopology& topology, uint32_t e, uint32_t f) {
  const Triangle& t = mesh.triangles[f];
  for (size_t k = 0; k < 3; ++k) {
    if (topology.face_edges[f][k] == e) return t[k] == topology.edges[e].vertices[0];
  }
  return false;
}

ConnectedPart walk(const TriangleMesh& mesh, const MeshTopology& topology, uint32_t seed,
                   std::vector<int8_t>& state) {
  ConnectedPart part;
  part.triangles.push_back(seed);
  state[seed] = 0;
  for (size_t i = 0; i < part.triangles.size(); ++i) {
    const uint32_t f = part.triangles[i];
    for (uint32_t e : topology.face_edges[f]) {
      if (e == no_index) continue;
      const MeshEdge& edge = topology.edges[e];
      if (edge.face_count != 2) {
        part.closed = false;
        continue;
      }
      const uint32_t g = edge.faces[0] == f ? edge.faces[1] : edge.faces[0];
      const bool same = runs_forward(mesh, topology, e, f) == runs_forward(mesh, topology, e, g);
      const auto wanted = int8_t(same ? 1 - state[f] : state[f]);
      if (state[g] < 0) {
        state[g] = wanted;
        part.triangles.push_back(g);
      } else if (state[g] != wanted) {
        part.orientable = false;
      }
    }
  }
  for (uint32_t f : part.triangles) part.turned.push_back(uint8_t(state[f]));
  return part;
}

void turn(TriangleMesh& mesh, uint32_t f) {
  std::swap(mesh.triangles[f][1], mesh.triangles[f][2]);
}

void measure(const TriangleMesh& mesh, ConnectedPart& part) {
  for (uint32_t f : part.triangles) part.box.include(triangle_bounds(mesh, f));
  const Vec3 origin = part.box.centre();
  for (uint32_t f : part.triangles) {
    const Vec3 a = mesh.corner(f, 0) - origin;
    part.volume6 += a.dot((mesh.corner(f, 1) - origin).cross(mesh.corner(f, 2) - origin));
  }
}

/// Whether the bounding box of `inner` lies in that of `outer`: sufficient to leave cavities
/// unchanged.
bool inside(const ConnectedPart& inner, const ConnectedPart& outer) {
  return outer.closed && outer.box.contains(inner.box.min) && outer.box.contains(inner.box.max) &&
         std::fabs(outer.volume6) > std::fabs(inner.volume6);
}

}  // namespace

OrientationReport orient_consistently(TriangleMesh& mesh) {
  const MeshTopology topology = build_topology(mesh);
  OrientationReport report;
  std::vector<int8_t> state(mesh.triangles.size(), -1);
  std::vector<ConnectedPart> parts;
  for (uint32_t seed = 0; seed < mesh.triangles.size(); ++seed) {
    if (state[seed] < 0) parts.push_back(walk(mesh, topology, seed, state));
  }
  for (ConnectedPart& part : parts) {
    if (!part.orientable) {
      ++report.unorientable_parts;
      report.unorientable.push_back(part.triangles[0]);
      part.closed = false;
      continue;
    }
    size_t against = 0;
    for (uint8_t t : part.turned) against += t;
    const uint8_t minority = 2 * against > part.turned.size() ? 0 : 1;
    for (size_t i = 0; i < part.triangles.size(); ++i) {
      if (part.turned[i] != minority) continue;
      turn(mesh, part.triangles[i]);
      report.flipped.push_back(part.triangles[i]);
    }
    measure(mesh, part);
  }
  // Only the largest parts are tested for containing others, since there may be many parts.
  std::vector<const ConnectedPart*> largest;
  for (const ConnectedPart& part : parts) {
    if (part.closed) largest.push_back(&part);
  }
  std::stable_sort(largest.begin(), largest.end(),
                   [](const ConnectedPart* a, const ConnectedPart* b) {
                     return std::fabs(a->volume6) > std::fabs(b->volume6);
                   });
  largest.resize(std::min(largest.size(), most_outer_parts));
  for (const ConnectedPart& part : parts) {
    if (!part.closed || part.volume6 >= 0) continue;
    const bool cavity = std::any_of(
        largest.begin(), largest.end(),
        [&](const ConnectedPart* outer) { return outer != &part && inside(part, *outer); });
    if (cavity) continue;
    for (uint32_t f : part.triangles) turn(mesh, f);
    report.turned_parts.push_back(part.triangles[0]);
  }
  std::sort(report.flipped.begin(), report.flipped.end());
  report.flipped_triangles = report.flipped.size();
  report.flipped_parts = report.turned_parts.size();
  return report;
}

}  // namespace tumble
