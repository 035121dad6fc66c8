#pragma once
#include "viewer/render/gpu_layout.hpp"
#include "viewer/render/render_scene.hpp"

namespace tumble {

/// Instances of one mesh that one call draws.
struct Batch {
  MeshRef mesh;
  uint32_t first = 0;  ///< in DrawPlan::instances
  uint32_t count = 0;
  bool patterned = false;  ///< in the opaque layer: the others' shaders ask each instance
};

/// Particles that one call draws.
struct SphereRun {
  uint32_t first = 0;  ///< its vertices start at three times this
  uint32_t count = 0;
};

/// A scene sorted for drawing: what the camera sees, at its level of detail, and what casts
/// shadows. Depends on nothing but the scene and the size of the picture.
struct DrawPlan {
  std::vector<GpuInstance> instances;
  std::vector<Batch> opaque;    ///< near to far within a mesh, plain ones first
  std::vector<Batch> blended;   ///< far to near
  std::vector<Batch> outlined;  ///< selected ones, grown
  std::vector<Batch> casters;   ///< without balls
  std::vector<Batch> low;       ///< casters near enough to the ground for contact shade, coarse
  std::vector<GpuSphere> sphere_vertices;  ///< three equal ones a particle, sorted into runs
  SphereRun opaque_spheres, blended_spheres, sphere_casters, low_spheres;
  SphereRun ball_casters;  ///< bodies that cast the shadow of a particle
  uint32_t visible = 0;
  uint32_t culled = 0;
};

/// What the plan is made for.
struct ViewSetup {
  Mat4 clip_from_world;
  Vec3 eye, right, up, forward;
  int width = 0, height = 0;                  ///< of the picture [px]
  double pixels_per_radian = 1000;            ///< height of the picture / (2 tan(fov / 2))
  Frustum shadow_volume;                      ///< casters outside of it are left out
  Mat4 shadow_from_world = Mat4::Identity();  ///< to 0..1
  int shadow_size = 0;                        ///< [texels]
  bool shadows = true;
  double contact_below = 0;  ///< [m] bodies that reach under this height shade the ground
};

/// `plan` keeps its memory between frames.
void make_draw_plan(const RenderScene& scene, const ViewSetup& view, DrawPlan& plan);

}  // namespace tumble
