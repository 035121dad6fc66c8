#pragma once
#include "viewer/render/render_scene.hpp"

namespace tumble {

// Shapes with rounded edges are a sharp-edged core whose vertices are moved out along their normals
// ("inflated"): a box of half extents h and edge radius r is the unit cube scaled by h - r and
// inflated by r. One mesh thus serves every size and can be drawn instanced.

MeshRef sphere_mesh();  ///< unit radius, with coarser versions
MeshRef ball_card();    ///< a triangle facing the camera (impostor) for balls whose outline the
                        ///< shader computes per pixel
MeshRef box_mesh();  ///< corners at +-1, chamfers that gain width by inflation; the coarser version
                     ///< is a plain cube
MeshRef cylinder_mesh();  ///< unit radius, y in +-1, with a rim that gains width by inflation
MeshRef capsule_mesh();   ///< core: the segment y in +-1; the radius is the inflation
MeshRef plane_mesh();     ///< one square in x, z of +-1, facing +y
MeshRef cone_mesh();      ///< base radius 1 at y = 0, tip at y = 1

/// Instances of the given true size [m]; edges of boxes and cylinders get a small rounding.
MeshInstance sphere_instance(const Pose& pose, double radius, const Paint& paint);
MeshInstance ellipsoid_instance(const Pose& pose, const Vec3& semi_axes, const Paint& paint);
MeshInstance box_instance(const Pose& pose, const Vec3& half_extents, const Paint& paint);
/// The axis is the body's y axis, the flat ends at +-half_height.
MeshInstance cylinder_instance(const Pose& pose, double radius, double half_height,
                               const Paint& paint);
/// The axis is the body's y axis; `half_height` is half the length of the segment, without the
/// caps.
MeshInstance capsule_instance(const Pose& pose, double radius, double half_height,
                              const Paint& paint);
/// A straight arrow from a to b of solid triangles, shaft radius [m].
void add_arrow(RenderScene& scene, const Vec3& a, const Vec3& b, double radius, const Paint& paint);
MeshInstance mesh_instance(const MeshRef& mesh, const Pose& pose, const Vec3& scale,
                           const Paint& paint);

}  // namespace tumble
