#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/geometry/solid/solid_report.hpp"

namespace tumble {
MassProperties mesh_integrals(const TriangleMesh& mesh, double density) {
  const Aabb box = bounds(mesh);
  if (box.empty()) return {};
  const Vec3 origin = box.centre();
  double volume6 = 0;
  Vec3 moment24 = Vec3::Zero();
  Mat3 second120 = Mat3::Zero();
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = mesh.corner(t, 0) - origin, b = mesh.corner(t, 1) - origin,
               c = mesh.corner(t, 2) - origin;
    // From two sides, so that small triangles lose nothing to cancellation.
    const double d = a.dot((b - a).cross(c - a));
    const Vec3 s = a + b + c;
    volume6 += d;
    moment24 += d * s;
    second120 +=
        d * (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
  }
  MassProperties out;
  const double volume = volume6 / 6;
  out.mass = density * volume;
  if (volume == 0) {
    out.centre = origin;
    return out;
  }
  const Vec3 centre = moment24 / (24 * volume);
  const Mat3 second = second120 / 120 - volume * centre * centre.transpose();
  out.centre = origin + centre;
  out.inertia = density * (second.trace() * Mat3::Identity() - second);
  return out;
}

Result<MassProperties> mesh_mass(const TriangleMesh& mesh, double density) {
  if (const Status ok = check_solid(mesh).status(); !ok) return ok.error();
  return mesh_integrals(mesh, density);
}

MassProperties polyhedron_mass(const ConvexPolyhedron& polyhedron, double density) {
  return mesh_integrals(to_mesh(polyhedron), density);
}

}  // namespace tumble
