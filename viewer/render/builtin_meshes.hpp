#pragma once
#include "viewer/render/render_scene.hpp"

namespace tumble {

// Shapes with round edges are a sharp core moved out along its normals: a box of half extents h is
// the unit cube scaled by h - r and inflated by r. So one mesh serves every size and is instanced.

MeshRef sphere_mesh();    ///< unit radius, with coarser versions
MeshRef ball_card();      ///< stands for sphere_mesh() wherever its true outline is drawn
MeshRef box_mesh();       ///< corners at +-1, chamfers that open when inflated; coarser: plain cube
MeshRef cylinder_mesh();  ///< unit radius, y in +-1, rim that opens when inflated
MeshRef capsule_mesh();   ///< core: the segment y in +-1; the radius is the inflation
MeshRef plane_mesh();     ///< one square in x, z of +-1, facing +y
MeshRef cone_mesh();      ///< base radius 1 at y = 0, tip at y = 1

/// Instances of the given true size [m]; edges of boxes and cylinders get a small round.
MeshInstance sphere_instance(const Pose& pose, double radius, const Paint& paint);
MeshInstance ellipsoid_instance(const Pose& pose, const Vec3& semi_axes, const Paint& paint);
MeshInstance box_instance(const Pose& pose, const Vec3& half_extents, const Paint& paint);
/// Axis along body y, flat ends at +-half_height.
MeshInstance cylinder_instance(const Pose& pose, double radius, double half_height,
                               const Paint& paint);
/// Axis along body y; `half_height` is half the length of the segment, without the caps.
MeshInstance capsule_instance(const Pose& pose, double radius, double half_height,
                              const Paint& paint);
/// A straight arrow from a to b of solid triangles, shaft radius [m].
void add_arrow(RenderScene& scene, const Vec3& a, const Vec3& b, double radius, const Paint& paint);
MeshInstance mesh_instance(const MeshRef& mesh, const Pose& pose, const Vec3& scale,
                           const Paint& paint);

}  // namespace tumble
