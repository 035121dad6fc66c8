#pragma once
#include "viewer/render/frame_setup.hpp"
#include "viewer/render/pipelines.hpp"
#include "viewer/render/sun_veil.hpp"

namespace tumble {

/// Draws liquids and smoke. Before, solid surfaces have been drawn into the canvas, and their
/// depth, where it is needed, into a single-sampled target. Then:
///   1. the shade that liquids cast is blended over the canvas where it can fall (veil_shade);
///   2. the canvas is copied, to be seen refracted through liquids;
///   3. for each liquid: the depth of its balls (fluid_depth), which is smoothed (narrow_range_x,
///   _y),
///      the thickness of the liquid (fluid_thickness, half size), and the surface onto the canvas
///      (fluid_surface);
///   4. smoke, far to near, into a target of its own (smoke), at half size unless the quality is
///   high,
///      since smoke is smooth and has the most overdraw; in scenes without liquids, the shade that
///      smoke casts is the first layer of that target (veil_layer);
///   5. after other transparent things, the renderer blends that target over the canvas
///   (smoke_cover).
class SoftPass {
 public:
  SoftPass(Device& device, const Pipelines& pipelines);
  ~SoftPass();
  SoftPass(const SoftPass&) = delete;
  SoftPass& operator=(const SoftPass&) = delete;

  /// Makes what the liquids and the smoke of the scene need and is not there yet.
  Status prepare(const RenderScene& scene, int width, int height);
  /// Determines where liquids and smoke are in this picture, and the light of the sun that they
  /// leave (SunVeil).
  void plan(const RenderScene& scene, const FrameSetup& setup);
  /// Parts of the picture that contain smoke and its shade.
  std::span<const ScissorRect> smoke_places() const { return smoke_parts_; }
  /// The target that must hold the depth of solid surfaces: where there is smoke, or everywhere if
  /// there are liquids.
  TargetId solid() const { return solid_; }
  /// Must be called outside a pass. `base`: a draw call with the constants of the frame, and the
  /// shadow map as its first texture.
  void draw_liquids(const RenderScene& scene, const FrameSetup& setup, TargetId canvas,
                    const DrawCall& base);
  /// Must be called outside a pass too, after draw_liquids of the same picture.
  void draw_smoke(const RenderScene& scene, const DrawCall& base);
  /// Composites the smoke over the canvas; must be called within the pass that draws into the
  /// canvas.
  void cover_with_smoke(const DrawCall& base);

 private:
  DrawCall call(const DrawCall& base, PipelineId pipeline, std::initializer_list<TextureId> after);
  void plan_shade(const RenderScene& scene, const FrameSetup& setup);
  void cast_shade(TargetId canvas, const DrawCall& base);
  void draw_liquid(const FluidSurface& fluid, const FrameSetup& setup, Quality quality,
                   TargetId canvas, const DrawCall& base);
  void smooth_front(Quality quality, const ScissorRect& area, const DrawCall& base);
  Status make(TargetId& target, const TargetDesc& desc);
  Status make_for_liquids();
  Status make_for_smoke();
  void release();

  Device& device_;
  const Pipelines& pipelines_;
  int width_ = 0, height_ = 0;
  int smoke_scale_ = 1;  ///< pixels of the picture per pixel of the smoke target, along each axis
  TargetId solid_, behind_, front_, other_, thickness_, smoke_;
  std::optional<ScissorRect> shade_area_;  ///< part of the picture where shade can fall
  std::vector<ScissorRect> smoke_parts_;   ///< parts of the picture with smoke or its shade
  std::vector<GpuPuff> smoke_puffs_;
  TextureId veil_texture_, puffs_;
  BufferId balls_, puff_instances_, uniforms_;
  SunVeil veil_;
  GpuSoft soft_{};
  std::vector<GpuFluidParticle> ball_vertices_;
};

}  // namespace tumble
