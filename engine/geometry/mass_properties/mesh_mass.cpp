#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/geometry/mass_properties/moment_sums.hpp"
#include "engine/geometry/solid/solid_report.hpp"

namespace tumble {
namespace {

/// An origin near the middle of the mesh, from the bounds of at most 64 triangles spread over it.
Vec3 local_origin(const TriangleMesh& mesh) {
  const size_t step = (mesh.triangles.size() + 63) / 64;
  Aabb box;
  for (size_t t = 0; t < mesh.triangles.size(); t += step) {
    for (size_t k = 0; k < 3; ++k) box.include(mesh.corner(t, k));
  }
  return box.centre();
}

}  // namespace

MassProperties mesh_integrals(const TriangleMesh& mesh, double density) {
  if (mesh.triangles.empty()) return {};
  const Vec3 origin = local_origin(mesh);
  const MomentSums sums = sum_moments(mesh, origin);
  SolidMoments m = moments_about_centre(sums, origin);
  if (too_rough(sums, m, origin)) m = precise_moments(mesh, origin);
  return {density * m.volume, m.centre, density * m.inertia};
}

Result<MassProperties> mesh_mass(const TriangleMesh& mesh, double density) {
  if (const Status ok = check_solid(mesh).status(); !ok) return ok.error();
  return mesh_integrals(mesh, density);
}

MassProperties polyhedron_mass(const ConvexPolyhedron& polyhedron, double density) {
  return mesh_integrals(to_mesh(polyhedron), density);
}

}  // namespace tumble
