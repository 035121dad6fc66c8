#pragma once
#include "engine/geometry/hull/convex_polyhedron.hpp"
#include "engine/geometry/triangle_mesh.hpp"

#include <span>

namespace tumble {

/// Mass, centre of mass and inertia tensor of a body.
struct MassProperties {
  double mass = 0;              ///< [kg]; the volume [m^3] at density 1
  Vec3 centre = Vec3::Zero();   ///< [m]
  Mat3 inertia = Mat3::Zero();  ///< about the centre, in the axes of the shape [kg m^2]

  /// The same shape with all mass multiplied by `factor` (a density, say).
  MassProperties times(double factor) const { return {factor * mass, centre, factor * inertia}; }
};

// Closed forms at a uniform density [kg/m^3], about the origin of the shape.
MassProperties sphere_mass(double radius, double density = 1);
MassProperties box_mass(const Vec3& half_extents, double density = 1);
/// Along Y; `half_height` is half the length of the axis segment.
MassProperties capsule_mass(double half_height, double radius, double density = 1);
/// Along Y.
MassProperties cylinder_mass(double half_height, double radius, double density = 1);

/// Seen from the frame in which the shape has this pose.
MassProperties moved(const MassProperties& m, const Pose& pose);
/// Parts of one rigid body, all given in the same frame (parallel axes theorem). No parts, or no
/// mass, give zeros.
MassProperties compound(std::span<const MassProperties> parts);

/// Inertia tensor about a point other than the centre: I + m (|d|^2 1 - d d^T).
Mat3 inertia_about(const MassProperties& m, const Vec3& point);

/// Volume integrals of a solid bounded by triangles: the divergence theorem over faces
/// (Mirtich, "Fast and Accurate Computation of Polyhedral Mass Properties", 1996), in the form of
/// signed tetrahedra about a local origin, so that the distance from the world's origin costs no
/// accuracy. Relative error below 1e-12.
/// Errors, each naming edges by their vertices: open edges, non-manifold edges, inconsistent
/// orientation, inside-out (negative volume), no volume. A caller may then take the hull's.
Result<MassProperties> mesh_mass(const TriangleMesh& mesh, double density = 1);

/// The same integrals without any check of the mesh; the mass is signed. For meshes already known
/// to be closed.
MassProperties mesh_integrals(const TriangleMesh& mesh, double density = 1);

MassProperties polyhedron_mass(const ConvexPolyhedron& polyhedron, double density = 1);

}  // namespace tumble
