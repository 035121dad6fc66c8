#include "engine/geometry/mesh_topology.hpp"

#include "engine/geometry/mesh_sides.hpp"
#include "engine/math/det/det.hpp"

#include <algorithm>

namespace tumble {
namespace {

EdgeBend bend_of(const TriangleMesh& mesh, const MeshTopology& topology, const MeshEdge& edge,
                 uint32_t forward_face, uint32_t back_face, double flat_sine) {
  const Vec3& n0 = topology.face_normals[forward_face];
  const Vec3& n1 = topology.face_normals[back_face];
  const Vec3 along = (mesh.vertices[edge.vertices[1]] - mesh.vertices[edge.vertices[0]]);
  const double length = along.norm();
  if (!(length > 0)) return EdgeBend::flat;
  // The sine of the exterior dihedral angle by which the normals turn about the edge; positive at a
  // ridge.
  const double sine = n0.cross(n1).dot(along) / length;
  if (std::fabs(sine) <= flat_sine) {
    // Folded back by a half turn: a blade counts as a ridge, not as flat.
    return n0.dot(n1) < 0 ? EdgeBend::convex : EdgeBend::flat;
  }
  return sine > 0 ? EdgeBend::convex : EdgeBend::concave;
}

void build_edges(const TriangleMesh& mesh, MeshTopology& out, double flat_sine) {
  const std::vector<MeshSide> sides = sorted_sides(mesh);
  out.face_edges.assign(mesh.triangles.size(), {no_index, no_index, no_index});
  for (size_t i = 0; i < sides.size();) {
    size_t end = i;
    while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high)
      ++end;
    MeshEdge edge;
    edge.vertices = {sides[i].low, sides[i].high};
    edge.face_count = uint32_t(end - i);
    for (size_t s = i; s < end; ++s) {
      if (s - i < 2) edge.faces[s - i] = sides[s].face;
      edge.normal += out.face_normals[sides[s].face];
      out.face_edges[sides[s].face][sides[s].k] = uint32_t(out.edges.size());
    }
    const double length = edge.normal.norm();
    edge.normal = length > 1e-12 ? Vec3(edge.normal / length) : Vec3(Vec3::Zero());
    if (edge.face_count == 1) ++out.open_edges;
    if (edge.face_count > 2) ++out.non_manifold_edges;
    if (edge.face_count == 2) {
      if (sides[i].forward == sides[i + 1].forward) {
        ++out.misoriented_edges;
      } else {
        const uint32_t first = sides[i].forward ? edge.faces[0] : edge.faces[1];
        const uint32_t second = sides[i].forward ? edge.faces[1] : edge.faces[0];
        edge.bend = bend_of(mesh, out, edge, first, second, flat_sine);
      }
    }
    out.edges.push_back(edge);
    i = end;
  }
}

/// Compressed lists: for each vertex, the items whose `corners(item)` contain it.
template <class Items>
void build_lists(size_t vertex_count, const Items& items, std::vector<uint32_t>& first,
                 std::vector<uint32_t>& list) {
  first.assign(vertex_count + 1, 0);
  const auto distinct = [](const auto& corners, size_t k) {
    for (size_t j = 0; j < k; ++j) {
      if (corners[j] == corners[k]) return false;
    }
    return true;
  };
  for (const auto& corners : items) {
    for (size_t k = 0; k < corners.size(); ++k) {
      if (distinct(corners, k)) ++first[corners[k] + 1];
    }
  }
  for (size_t v = 0; v < vertex_count; ++v) first[v + 1] += first[v];
  list.assign(first[vertex_count], 0);
  std::vector<uint32_t> cursor(first.begin(), first.end() - 1);
  for (uint32_t i = 0; i < items.size(); ++i) {
    for (size_t k = 0; k < items[i].size(); ++k) {
      if (distinct(items[i], k)) list[cursor[items[i][k]]++] = i;
    }
  }
}

void build_vertex_normals(const TriangleMesh& mesh, MeshTopology& out) {
  out.vertex_normals.assign(mesh.vertices.size(), Vec3::Zero());
  for (size_t f = 0; f < mesh.triangles.size(); ++f) {
    for (size_t k = 0; k < 3; ++k) {
      const Vec3& p = mesh.corner(f, k);
      const Vec3 u = mesh.corner(f, (k + 1) % 3) - p, v = mesh.corner(f, (k + 2) % 3) - p;
      const double angle = det::atan2(u.cross(v).norm(), u.dot(v));
      out.vertex_normals[mesh.triangles[f][k]] += angle * out.face_normals[f];
    }
  }
  for (Vec3& n : out.vertex_normals) {
    const double length = n.norm();
    n = length > 1e-12 ? Vec3(n / length) : Vec3(Vec3::Zero());
  }
}

}  // namespace

MeshTopology build_topology(const TriangleMesh& mesh, double flat_sine) {
  MeshTopology out;
  out.face_normals.reserve(mesh.triangles.size());
  for (size_t f = 0; f < mesh.triangles.size(); ++f)
    out.face_normals.push_back(face_normal(mesh, f));
  build_edges(mesh, out, flat_sine);

  build_lists(mesh.vertices.size(), mesh.triangles, out.vertex_face_first, out.vertex_faces);
  std::vector<std::array<uint32_t, 2>> ends;
  ends.reserve(out.edges.size());
  for (const MeshEdge& e : out.edges) ends.push_back(e.vertices);
  build_lists(mesh.vertices.size(), ends, out.vertex_edge_first, out.vertex_edges);

  build_vertex_normals(mesh, out);
  for (size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (out.vertex_face_first[v + 1] > out.vertex_face_first[v]) ++out.used_vertices;
  }
  out.euler_characteristic =
      int64_t(out.used_vertices) - int64_t(out.edges.size()) + int64_t(mesh.triangles.size());
  return out;
}

}  // namespace tumble
