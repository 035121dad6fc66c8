#pragma once
#include "viewer/render/gpu_layout.hpp"
#include "viewer/render/render_scene.hpp"

namespace tumble {

/// Instances of one mesh that are drawn by one call.
struct Batch {
  MeshRef mesh;
  uint32_t first = 0;  ///< in DrawPlan::instances
  uint32_t count = 0;
  bool patterned = false;  ///< uses the shaders for patterns; set only in the opaque layer, in
                           ///< others every shader tests for a pattern
};

/// Particles that are drawn by one call.
struct SphereRun {
  /// Index of the run's first particle; its vertices start at three times this.
  uint32_t first = 0;
  uint32_t count = 0;
};

/// A scene sorted for drawing: the visible instances at their level of detail, and the casters of
/// shadows. Depends only on the scene and the size of the picture.
struct DrawPlan {
  std::vector<GpuInstance> instances;
  std::vector<Batch> opaque;    ///< within a mesh: unpatterned ones first, then near to far
  std::vector<Batch> blended;   ///< far to near
  std::vector<Batch> outlined;  ///< selected instances, enlarged to draw their outline
  std::vector<Batch> casters;   ///< shadow casters, except balls
  /// Coarse versions of casters near enough to the ground to darken it (contact shade).
  std::vector<Batch> low;
  std::vector<GpuSphere> sphere_vertices;  ///< three equal vertices per particle, sorted into runs
  SphereRun opaque_spheres, blended_spheres, sphere_casters, low_spheres;
  SphereRun ball_casters;  ///< bodies that are balls: they cast the shadow of a particle
  uint32_t visible = 0;
  uint32_t culled = 0;
};

/// The view for which a plan is made.
struct ViewSetup {
  Mat4 clip_from_world;
  Vec3 eye, right, up, forward;
  int width = 0, height = 0;                  ///< of the picture [px]
  double pixels_per_radian = 1000;            ///< height of the picture / (2 tan(fov / 2))
  Frustum shadow_volume;                      ///< casters outside of this volume are left out
  Mat4 shadow_from_world = Mat4::Identity();  ///< maps the shadow volume to 0..1
  int shadow_size = 0;                        ///< [texels]
  bool shadows = true;
  /// [m] bodies that reach below this height darken the ground (contact shade).
  double contact_below = 0;
};

/// `plan` is overwritten; its memory is reused between frames.
void make_draw_plan(const RenderScene& scene, const ViewSetup& view, DrawPlan& plan);

}  // namespace tumble
