#include "viewer/app/mesh/mesh_facts.hpp"

#include "engine/core/watched.hpp"
#include "engine/geometry/hull/convex_hull.hpp"
#include "engine/scene/mesh_files/formats.hpp"

#include <utility>

namespace tumble {
namespace {

/// By when so much of the time of mesh_facts has passed, on a torus of a million triangles [-].
constexpr double share_of_topology = 0.05, share_of_check = 0.35, share_of_mass = 0.5;

HullFacts hull_facts(const TriangleMesh& mesh, double density) {
  HullFacts out;
  const auto hull = convex_hull(mesh.vertices);
  if (!hull) {
    out.missing = hull.error().text();
    return out;
  }
  const ConvexPolyhedron& p = hull->polyhedron;
  out.vertices = p.vertices.size();
  out.facets = p.face_count();
  out.mass = polyhedron_mass(p, density);
  out.volume = out.mass.mass / density;
  out.area = surface_area(to_mesh(p));
  return out;
}

}  // namespace

MeshFacts mesh_facts(std::string file, ImportedMesh imported, double density) {
  MeshFacts f;
  if (const auto format = mesh_format_of(file)) f.format = (*format)->name;
  f.file = std::move(file);
  f.density = density;
  f.mesh = std::make_shared<const TriangleMesh>(std::move(imported.mesh));
  f.parts = std::move(imported.parts);
  f.cleanup = std::move(imported.cleanup);
  f.notes = std::move(imported.notes);
  f.topology = build_topology(*f.mesh);
  tell_progress(share_of_topology);
  f.holes = find_holes(*f.mesh);
  f.solid = check_solid(*f.mesh);
  tell_progress(share_of_check);
  f.box = bounds(*f.mesh);
  f.area = surface_area(*f.mesh);
  if (f.solid.solid()) {
    f.mass = mesh_mass(*f.mesh, density);
  } else {
    f.mass = f.solid.status().error();
  }
  if (f.mass) f.principal = principal_axes(f.mass->inertia);
  tell_progress(share_of_mass);
  f.hull = hull_facts(*f.mesh, density);
  f.hierarchies = hierarchy_facts(f.mesh, f.hull.volume, f.area, share_of_mass);
  return f;
}

}  // namespace tumble
