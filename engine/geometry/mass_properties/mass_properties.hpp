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
/// Along Y, base at -half_height, tip at +half_height; the centre is a quarter of the height above
/// the base.
MassProperties cone_mass(double half_height, double radius, double density = 1);
MassProperties ellipsoid_mass(const Vec3& radii, double density = 1);
/// Around Y; `major` from the centre to the tube's middle, `minor` the tube's radius.
MassProperties torus_mass(double major, double minor, double density = 1);
/// Any order of the corners. Tonon, "Explicit exact formulas for the 3-D tetrahedron inertia tensor
/// in terms of its vertex coordinates" (2004).
MassProperties tetrahedron_mass(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d,
                                double density = 1);

/// Seen from the frame in which the shape has this pose.
MassProperties moved(const MassProperties& m, const Pose& pose);
/// Parts of one rigid body, all given in the same frame (parallel axes theorem). No parts, or no
/// mass, give zeros.
MassProperties compound(std::span<const MassProperties> parts);

/// Inertia tensor about a point other than the centre: I + m (|d|^2 1 - d d^T).
Mat3 inertia_about(const MassProperties& m, const Vec3& point);

/// Whether a body can have these: finite, mass > 0, the inertia symmetric, no principal moment
/// below zero or above the sum of the other two by more than `slack` of the largest (thin plates
/// reach equality). The error says which and by how much.
Status check_physical(const MassProperties& m, double slack = 1e-12);

/// Volume integrals of a solid bounded by triangles: the divergence theorem over faces
/// (Mirtich, "Fast and Accurate Computation of Polyhedral Mass Properties", 1996), in the form of
/// signed tetrahedra about a local origin (moment_sums.hpp), so that the distance from the world's
/// origin costs no accuracy. Volume, inertia (by its norm) and centre (by the solid's size) are
/// within 1e-14 of what the coordinates given say, however thin or wound the solid is: where the
/// rounding of a sum in double may be more, it is done again with twice the digits. The centre is
/// besides rounded to double.
/// Errors, of what check_solid() (solid/solid_report.hpp) finds: open or non-manifold edges,
/// inconsistent orientation, no volume, inside-out, self-intersection; each with the offending
/// edges or triangles. A caller may then take the hull's.
Result<MassProperties> mesh_mass(const TriangleMesh& mesh, double density = 1);

/// The same integrals without any check of the mesh; the mass is signed, and the inertia with it.
/// For meshes already known to be closed.
MassProperties mesh_integrals(const TriangleMesh& mesh, double density = 1);

MassProperties polyhedron_mass(const ConvexPolyhedron& polyhedron, double density = 1);

}  // namespace tumble
