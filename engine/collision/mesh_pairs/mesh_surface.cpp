#include "engine/collision/mesh_pairs/mesh_surface.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// Dihedral angles below this count as flat [rad]: meshes stored in single precision are no
/// flatter.
constexpr double flat_sine = 1e-4;

void mark_active(MeshSurface& s) {
  const MeshTopology& t = s.topology;
  s.edge_active.assign(t.edges.size(), 0);
  s.vertex_active.assign(s.mesh->vertices.size(), 0);
  for (size_t e = 0; e < t.edges.size(); ++e) {
    const MeshEdge& edge = t.edges[e];
    if (edge.bend != EdgeBend::convex && edge.bend != EdgeBend::open) continue;
    s.edge_active[e] = 1;
    for (uint32_t v : edge.vertices) s.vertex_active[v] = 1;
  }
}

void assign_owners(MeshSurface& s) {
  const MeshTopology& t = s.topology;
  s.owned.assign(s.mesh->triangles.size(), 0);
  for (uint32_t f = 0; f < s.owned.size(); ++f) {
    for (unsigned k = 0; k < 3; ++k) {
      const uint32_t v = s.mesh->triangles[f][k], e = t.face_edges[f][k];
      if (s.vertex_active[v] && t.faces_of_vertex(v)[0] == f) s.owned[f] |= uint8_t(1u << k);
      if (e != no_index && s.edge_active[e] && t.edges[e].faces[0] == f)
        s.owned[f] |= uint8_t(8u << k);
    }
  }
}

void measure_thickness(MeshSurface& s) {
  const size_t n = s.mesh->triangles.size();
  s.thickness.resize(n);
  s.min_thickness = s.size;
  s.max_thickness = 0;
  for (size_t f = 0; f < n; ++f) {
    const Vec3& normal = s.topology.face_normals[f];
    double t = s.size;
    if (!normal.isZero()) {
      const Vec3 middle = (s.mesh->corner(f, 0) + s.mesh->corner(f, 1) + s.mesh->corner(f, 2)) / 3;
      const double skin = 1e-7 * s.size;
      if (auto hit = s.tree->ray({middle - skin * normal, -normal}, s.size)) t = hit->t + skin;
    }
    s.thickness[f] = float(t);
    s.min_thickness = std::min(s.min_thickness, t);
    s.max_thickness = std::max(s.max_thickness, t);
  }
}

}  // namespace

double MeshSurface::thickness_along(std::span<const uint32_t> faces, const Vec3& direction) const {
  double least = size;
  for (uint32_t f : faces) {
    if (f == no_index) continue;
    const double along = std::abs(topology.face_normals[f].dot(direction));
    if (along > 0.5) least = std::min(least, double(thickness[f]) / along);
  }
  return least;
}

MeshSurface build_mesh_surface(std::shared_ptr<const TriangleMesh> mesh) {
  MeshSurface s;
  s.mesh = mesh;
  s.topology = build_topology(*mesh, flat_sine);
  s.tree = std::make_unique<AabbTree>(mesh);
  s.hierarchies = std::make_unique<HierarchySet>(mesh);
  s.closed = s.topology.closed();
  s.size = s.tree->bounds().extent().norm();
  mark_active(s);
  assign_owners(s);
  measure_thickness(s);
  return s;
}

MeshSurface reversed_surface(const MeshSurface& surface) {
  auto turned = std::make_shared<TriangleMesh>(*surface.mesh);
  flip(*turned);
  return build_mesh_surface(std::move(turned));
}

}  // namespace tumble
