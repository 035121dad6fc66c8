#pragma once
#include "viewer/render/frame_setup.hpp"
#include "viewer/render/pipelines.hpp"
#include "viewer/render/sun_veil.hpp"

namespace tumble {

/// Draws liquids and smoke. What is solid has been drawn into the canvas before, and its depth, as
/// far as it is needed, into a target of one sample; then
///   the shade that liquids cast is laid over the canvas where it can fall (veil_shade),
///   the canvas is copied, as it is seen through liquids,
///   of each liquid: its balls' distance (fluid_depth), that smoothed (narrow_range_x, _y), how
///   much
///     of it there is (fluid_thickness, half size), and the surface onto the canvas
///     (fluid_surface),
///   smoke, far to near, into a target of its own (smoke), at half size unless the quality is high:
///     it is soft, and overlaps itself most of all that is drawn; where there are no liquids, the
///     shade that it casts as its first layer (veil_layer),
///   after other see-through things, by the renderer: that smoke over the canvas (smoke_cover).
class SoftPass {
 public:
  SoftPass(Device& device, const Pipelines& pipelines);
  ~SoftPass();
  SoftPass(const SoftPass&) = delete;
  SoftPass& operator=(const SoftPass&) = delete;

  Status prepare(int width, int height, Quality quality);
  /// Where they are in this picture, and which light they leave.
  void plan(const RenderScene& scene, const FrameSetup& setup);
  /// Of the picture: hold smoke and its shade.
  std::span<const ScissorRect> smoke_places() const { return smoke_parts_; }
  /// Has to hold the depth of what is solid where smoke is, with liquids everywhere.
  TargetId solid() const { return solid_; }
  /// Outside a pass. `base`: a call with the frame's constants and the shadow map as its first
  /// texture.
  void draw_liquids(const RenderScene& scene, const FrameSetup& setup, TargetId canvas,
                    const DrawCall& base);
  /// Likewise, after draw_liquids of the same picture.
  void draw_smoke(const RenderScene& scene, const DrawCall& base);
  /// Lays it over the canvas, within the pass that draws into that.
  void cover_with_smoke(const DrawCall& base);

 private:
  DrawCall call(const DrawCall& base, PipelineId pipeline, std::initializer_list<TextureId> after);
  void plan_shade(const RenderScene& scene, const FrameSetup& setup);
  void cast_shade(TargetId canvas, const DrawCall& base);
  void draw_liquid(const FluidSurface& fluid, const FrameSetup& setup, Quality quality,
                   TargetId canvas, const DrawCall& base);
  void smooth_front(Quality quality, const ScissorRect& area, const DrawCall& base);
  Status make(TargetId& target, const TargetDesc& desc);
  void release();

  Device& device_;
  const Pipelines& pipelines_;
  int width_ = 0, height_ = 0;
  int smoke_scale_ = 1;  ///< pixels of the picture that one of the smoke's stands for, each way
  TargetId solid_, behind_, front_, other_, thickness_, smoke_;
  std::optional<ScissorRect> shade_area_;  ///< of the picture, that shade can fall into
  std::vector<ScissorRect> smoke_parts_;   ///< of the picture, that smoke and its shade are in
  std::vector<GpuPuff> smoke_puffs_;
  TextureId veil_texture_, puffs_;
  BufferId balls_, puff_instances_, uniforms_;
  SunVeil veil_;
  GpuSoft soft_{};
  std::vector<GpuFluidParticle> ball_vertices_;
};

}  // namespace tumble
