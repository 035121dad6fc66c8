#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/geometry/mass_properties/moment_sums.hpp"
#include "engine/geometry/solid/solid_report.hpp"

namespace tumble {
MassProperties mesh_integrals(const TriangleMesh& mesh, double density) {
  const Aabb box = bounds(mesh);
  if (box.empty()) return {};
  const Vec3 origin = box.centre();
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
