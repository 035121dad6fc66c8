#include "viewer/render/soft_pass.hpp"

#include "viewer/render/smoke_puffs.hpp"
#include "viewer/render/soft_plan.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// In radii of a ball: the reach of the surface's smoothing around a pixel, the range of distances
/// that take part in it, and the distance behind it that stands for everything deeper.
constexpr float smoothing_reach = 2.6f, narrow_range = 5, behind_range = 1;

struct SmoothingCost {
  int rounds;        ///< each consists of a horizontal and a vertical pass
  float most_reach;  ///< [px]
};
SmoothingCost smoothing_cost(Quality quality) {
  switch (quality) {
    case Quality::draft:
      return {1, 10};
    case Quality::standard:
      return {2, 22};
    case Quality::high:
      return {3, 40};
  }
  return {2, 22};
}

std::array<float, 16> floats_of(const Mat4& m) {
  std::array<float, 16> out;
  for (int i = 0; i < 16; ++i) out[size_t(i)] = float(m.data()[i]);
  return out;
}

/// The texels that a part of a picture touches in a target with `scale` pixels of the picture per
/// texel, each way.
ScissorRect reduced(const ScissorRect& part, int height, int scale) {
  const auto up = [scale](int pixels) { return (pixels + scale - 1) / scale; };
  const int low = height - part.y - part.height, high = height - part.y;
  const int x0 = part.x / scale, y0 = low / scale;
  return {x0, up(height) - up(high), up(part.x + part.width) - x0, up(high) - y0};
}

}  // namespace

SoftPass::SoftPass(Device& device, const Pipelines& pipelines)
    : device_(device), pipelines_(pipelines) {
  balls_ = device_.create_buffer(BufferUse::vertex, 0, {});
  puff_instances_ = device_.create_buffer(BufferUse::vertex, 0, {});
  uniforms_ = device_.create_buffer(BufferUse::uniform, 0, {});
}

SoftPass::~SoftPass() {
  release();
  for (const BufferId b : {balls_, puff_instances_, uniforms_}) device_.destroy(b);
  for (const TextureId t : {veil_texture_, puffs_})
    if (t) device_.destroy(t);
}

Status SoftPass::make(TargetId& target, const TargetDesc& desc) {
  auto made = device_.create_target(desc);
  if (!made) return made.error();
  target = *made;
  return {};
}

void SoftPass::release() {
  for (TargetId* t : {&solid_, &behind_, &front_, &other_, &thickness_, &smoke_}) {
    if (*t) device_.destroy(*t);
    *t = {};
  }
  width_ = height_ = 0;
}

Status SoftPass::prepare(const RenderScene& scene, int width, int height) {
  const int scale = scene.quality == Quality::high ? 1 : 2;
  if (width != width_ || height != height_ || scale != smoke_scale_) release();
  width_ = width;
  height_ = height;
  smoke_scale_ = scale;
  Status s;
  if (!solid_) {
    TargetDesc d;
    d.width = width;
    d.height = height;
    d.colour = ColourAttachment::none;
    d.depth = DepthAttachment::texture;
    s = make(solid_, d);
  }
  // What only one of the two needs is made with its first picture: each target's memory is written
  // when it is made.
  if (s && !scene.fluids.empty() && !front_) s = make_for_liquids();
  if (s && !scene.smoke.empty() && !smoke_) s = make_for_smoke();
  if (!s) release();
  return s;
}

Status SoftPass::make_for_liquids() {
  TargetDesc d;
  d.width = width_;
  d.height = height_;
  d.depth = DepthAttachment::none;
  Status s = make(behind_, d);
  d.colour = ColourAttachment::r32f;
  if (s) s = make(other_, d);
  d.depth = DepthAttachment::buffer;
  if (s) s = make(front_, d);
  d.width = (width_ + 1) / 2;
  d.height = (height_ + 1) / 2;
  d.colour = ColourAttachment::rgba16f;
  d.depth = DepthAttachment::none;
  if (s) s = make(thickness_, d);
  return s;
}

Status SoftPass::make_for_smoke() {
  if (!puffs_) {
    const PuffAtlas atlas = make_puff_atlas();
    puffs_ = device_.create_texture(TextureFormat::rgba8_linear_filter, atlas.size, atlas.size,
                                    std::as_bytes(std::span(atlas.texels)));
  }
  TargetDesc d;
  d.width = (width_ + smoke_scale_ - 1) / smoke_scale_;
  d.height = (height_ + smoke_scale_ - 1) / smoke_scale_;
  d.depth = DepthAttachment::none;
  return make(smoke_, d);
}

DrawCall SoftPass::call(const DrawCall& base, PipelineId pipeline,
                        std::initializer_list<TextureId> after) {
  DrawCall c = base;
  c.pipeline = pipeline;
  c.uniforms[1] = {uniforms_, 0, sizeof(GpuSoft)};
  std::copy(after.begin(), after.end(), c.textures.begin() + 1);
  return c;
}

void SoftPass::plan(const RenderScene& scene, const FrameSetup& setup) {
  soft_ = {};
  soft_.depths = {float(setup.camera.near), float(setup.camera.far),
                  float(setup.view.pixels_per_radian), float(smoke_scale_)};
  plan_shade(scene, setup);
  smoke_puffs_ = plan_smoke(scene, setup.view, veil_);
  SmokeShade shade;
  // With liquids the shade is coloured, and is blended over the canvas.
  shade.falls = shade_area_ && scene.fluids.empty();
  if (shade.falls) {
    const auto& sun = setup.uniforms.to_sun;
    shade.to_sun = Vec3(double(sun[0]), double(sun[1]), double(sun[2]));
    shade.lowest = setup.lowest;
    shade.blur = 2 / (veil_.veil_from_world.row(0).head<3>().norm() * veil_.size);
  }
  smoke_parts_ = smoke_parts(scene, smoke_puffs_, shade, setup.view);
}

void SoftPass::plan_shade(const RenderScene& scene, const FrameSetup& setup) {
  const Vec3 to_sun(setup.uniforms.to_sun[0], setup.uniforms.to_sun[1], setup.uniforms.to_sun[2]);
  const int size = scene.quality == Quality::high ? 512 : 256;
  make_sun_veil(scene, to_sun, setup.region, size, veil_);
  shade_area_.reset();
  if (veil_.size == 0 || !scene.sun.shadows) return;
  shade_area_ = shaded_area(veil_, to_sun, setup.lowest, setup.view);
  if (!shade_area_) return;
  if (veil_texture_) device_.destroy(veil_texture_);
  veil_texture_ = device_.create_texture(TextureFormat::rgba8_linear_filter, veil_.size, veil_.size,
                                         std::as_bytes(std::span(veil_.cells)));
  soft_.veil_from_world = floats_of(veil_.veil_from_world);
  // Depths are in steps of 1/255.
  float softness = 4.0f / 255;
  for (const FluidSurface& fluid : scene.fluids)
    softness = std::max(softness, 2 * fluid.radius / float(veil_.depth));
  soft_.veil = {1 / softness, 1, 0, 0};
}

void SoftPass::cast_shade(TargetId canvas, const DrawCall& base) {
  device_.update_buffer(uniforms_, bytes_of(soft_));
  device_.begin_pass({canvas, {}, false});
  DrawCall c = call(base, pipelines_.veil_shade, {device_.depth_texture(solid_), veil_texture_});
  c.count = 3;
  c.scissor = *shade_area_;
  device_.draw(c);
  device_.end_pass();
}

void SoftPass::draw_liquids(const RenderScene& scene, const FrameSetup& setup, TargetId canvas,
                            const DrawCall& base) {
  if (scene.fluids.empty()) return;
  if (shade_area_) cast_shade(canvas, base);
  device_.resolve(canvas, behind_);
  for (const FluidSurface& fluid : scene.fluids)
    draw_liquid(fluid, setup, scene.quality, canvas, base);
}

void SoftPass::smooth_front(Quality quality, const ScissorRect& area, const DrawCall& base) {
  const std::array<float, 4> nothing{0, 0, 0, 0};
  for (int round = 0; round < smoothing_cost(quality).rounds; ++round)
    for (const bool up : {false, true}) {
      device_.begin_pass({up ? front_ : other_, nothing, false});
      DrawCall c = call(base, up ? pipelines_.narrow_range_y : pipelines_.narrow_range_x, {});
      c.textures[0] = device_.colour_texture(up ? other_ : front_);
      c.count = 3;
      c.scissor = area;
      device_.draw(c);
      device_.end_pass();
    }
}

void SoftPass::draw_liquid(const FluidSurface& fluid, const FrameSetup& setup, Quality quality,
                           TargetId canvas, const DrawCall& base) {
  const LiquidPlan plan = plan_liquid(fluid, setup.view, ball_vertices_);
  if (plan.all == 0) return;
  const Vec3f sigma = absorption(fluid);
  soft_.absorb = {sigma.x(), sigma.y(), sigma.z(), fluid.fill};
  soft_.body = {fluid.colour.x(), fluid.colour.y(), fluid.colour.z(), 1};
  soft_.smooth = {smoothing_reach * fluid.radius, narrow_range * fluid.radius,
                  behind_range * fluid.radius, smoothing_cost(quality).most_reach};
  soft_.ball = {fluid.radius, 0, 0, 0};
  device_.update_buffer(uniforms_, bytes_of(soft_));
  device_.update_buffer(balls_, std::as_bytes(std::span(ball_vertices_)));
  const std::array<float, 4> nothing{0, 0, 0, 0};

  device_.begin_pass({front_, nothing, true});
  DrawCall c = call(base, pipelines_.fluid_depth, {});
  c.vertices = balls_;
  c.count = 3 * plan.front;
  if (plan.front > 0) device_.draw(c);
  device_.end_pass();
  smooth_front(quality, plan.area, base);

  device_.begin_pass({thickness_, nothing, false});
  c = call(base, pipelines_.fluid_thickness, {});
  c.textures[0] = device_.depth_texture(solid_);
  c.textures[1] = device_.colour_texture(front_);
  c.vertices = balls_;
  c.count = 3 * plan.all;
  device_.draw(c);
  device_.end_pass();

  device_.begin_pass({canvas, {}, false});
  c = call(base, pipelines_.fluid_surface,
           {device_.colour_texture(front_), device_.colour_texture(thickness_),
            device_.colour_texture(behind_), device_.depth_texture(solid_)});
  c.count = 3;
  c.scissor = plan.area;
  device_.draw(c);
  device_.end_pass();
}

void SoftPass::draw_smoke(const RenderScene& scene, const DrawCall& base) {
  if (smoke_parts_.empty()) return;
  soft_.veil[1] = float(smoke_scale_);
  device_.update_buffer(uniforms_, bytes_of(soft_));
  device_.begin_pass({smoke_, std::array<float, 4>{0, 0, 0, 1}, false});
  const TextureId depth = device_.depth_texture(solid_);
  if (shade_area_ && scene.fluids.empty())
    for (const ScissorRect& part : smoke_parts_) {
      DrawCall c = call(base, pipelines_.veil_layer, {depth, veil_texture_});
      c.count = 3;
      c.scissor = reduced(part, height_, smoke_scale_);
      device_.draw(c);
    }
  if (!smoke_puffs_.empty()) {
    device_.update_buffer(puff_instances_, std::as_bytes(std::span(smoke_puffs_)));
    DrawCall c = call(base, pipelines_.smoke, {puffs_, depth});
    c.instances = puff_instances_;
    c.count = 4;
    c.instance_count = uint32_t(smoke_puffs_.size());
    device_.draw(c);
  }
  device_.end_pass();
}

void SoftPass::cover_with_smoke(const DrawCall& base) {
  for (const ScissorRect& part : smoke_parts_) {
    DrawCall c = base;
    c.pipeline = pipelines_.smoke_cover;
    c.uniforms[1] = {uniforms_, 0, sizeof(GpuSoft)};
    c.textures[0] = device_.colour_texture(smoke_);
    c.textures[1] = device_.depth_texture(solid_);
    c.count = 3;
    c.scissor = part;
    device_.draw(c);
  }
}

}  // namespace tumble
