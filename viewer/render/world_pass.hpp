#pragma once
#include "viewer/render/draw_plan.hpp"
#include "viewer/render/ground_plan.hpp"
#include "viewer/render/marks.hpp"
#include "viewer/render/mesh_cache.hpp"
#include "viewer/render/picture_targets.hpp"
#include "viewer/render/pipelines.hpp"
#include "viewer/render/soft_pass.hpp"
#include "viewer/render/stream_buffer.hpp"

namespace tumble {

/// What was drawn for one world.
struct WorldDrawn {
  Camera camera;  ///< with near and far filled in
  uint32_t visible_instances = 0, culled_instances = 0;
};

/// Draws the world of a RenderScene, without text and panels: shadow map, contact shade of the
/// ground, surfaces, transparent bodies, lines and points, ground and sky.
class WorldPass {
 public:
  WorldPass(Device& device, const Pipelines& pipelines);

  /// Draws into prepared targets; `frame` is the number of the picture.
  Result<WorldDrawn> draw(const RenderScene& scene, PictureTargets& targets, uint64_t frame);
  /// Frees meshes last drawn before this picture.
  void forget_meshes_before(uint64_t frame) { meshes_.forget_before(frame); }

 private:
  /// Order of the layers.
  struct Layers {
    bool ground_under = false;  ///< ground and sky are blended under the averaged canvas
    bool smoke_last = false;    ///< smoke is drawn over the averaged canvas, not into the canvas
  };
  /// Parts of the canvas.
  struct CanvasParts {
    std::vector<ScissorRect> drawn;         ///< contain everything drawn except the ground
    std::vector<ScissorRect> below_ground;  ///< contain everything that the ground hides
    std::vector<ScissorRect> solid;  ///< those parts of them whose depth liquids and smoke need
  };

  DrawCall call(PipelineId pipeline) const;
  void fill_buffers(const FrameSetup& setup, const MarkRuns<GpuLine>& lines,
                    const MarkRuns<GpuPoint>& points);
  /// Uses the pipelines for plain and for patterned bodies.
  void draw_batches(const std::vector<Batch>& batches,
                    const std::array<BodyPipelines, 2>& pipelines);
  /// For layers without balls and patterns.
  void draw_batches(const std::vector<Batch>& batches, PipelineId closed, PipelineId open);
  void draw_spheres(const SphereRun& run, PipelineId pipeline);
  void draw_shadow_passes(const RenderScene& scene, const FrameSetup& setup);
  void draw_ground(uint32_t first, uint32_t count, PipelineId pipeline,
                   const std::optional<ScissorRect>& within = {});
  void draw_ground_depth(std::span<const ScissorRect> parts);
  void draw_solid_depth(const CanvasParts& parts, const Layers& layers);
  void draw_bodies(const RenderScene& scene);
  void draw_background(const RenderScene& scene, const FrameSetup& setup, bool under);
  void draw_canvas(const RenderScene& scene, const FrameSetup& setup, const CanvasParts& parts,
                   const Layers& layers);
  void draw_averaged(const RenderScene& scene, const FrameSetup& setup, const CanvasParts& parts,
                     const Layers& layers);
  void finish(bool is_averaged);
  void draw_blended(const RenderScene& scene);
  void enlarge();
  template <class T>
  void draw_marks(const MarkRuns<T>& runs, const StreamBuffer& buffer, PipelineId tested,
                  PipelineId hidden, PipelineId over);

  Device& device_;
  const Pipelines& pipelines_;
  MeshCache meshes_;
  SoftPass soft_;
  StreamBuffer frame_uniforms_, instances_, spheres_, lines_, points_;
  StreamBuffer ground_corners_, ground_triangles_;
  PictureTargets* targets_ = nullptr;  ///< of the picture being drawn
  uint64_t frame_ = 0;                 ///< number of the picture that is being drawn
  DrawPlan plan_;
  GroundPlan ground_plan_;
};

}  // namespace tumble
