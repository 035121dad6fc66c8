#include "viewer/render/world_pass.hpp"

#include "viewer/render/background.hpp"
#include "viewer/render/drawn_area.hpp"
#include "viewer/render/frame_setup.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// Clear colour of the canvas: black with full transmittance.
constexpr std::array<float, 4> nothing_drawn = {0, 0, 0, 1};

}  // namespace

WorldPass::WorldPass(Device& device, const Pipelines& pipelines)
    : device_(device),
      pipelines_(pipelines),
      meshes_(device),
      soft_(device, pipelines),
      frame_uniforms_(device, BufferUse::uniform),
      instances_(device, BufferUse::vertex),
      spheres_(device, BufferUse::vertex),
      lines_(device, BufferUse::vertex),
      points_(device, BufferUse::vertex),
      ground_corners_(device, BufferUse::vertex),
      ground_triangles_(device, BufferUse::index) {}

DrawCall WorldPass::call(PipelineId pipeline) const {
  DrawCall c;
  c.pipeline = pipeline;
  c.uniforms[0] = {frame_uniforms_.id(), 0, sizeof(GpuFrame)};
  c.textures = {targets_->shadow_map(), targets_->contact_map()};
  return c;
}

void WorldPass::fill_buffers(const FrameSetup& setup, const MarkRuns<GpuLine>& lines,
                             const MarkRuns<GpuPoint>& points) {
  frame_uniforms_.fill(bytes_of(setup.uniforms));
  instances_.fill(std::as_bytes(std::span(plan_.instances)));
  spheres_.fill(std::as_bytes(std::span(plan_.sphere_vertices)));
  lines_.fill(std::as_bytes(std::span(lines.all)));
  points_.fill(std::as_bytes(std::span(points.all)));
  ground_corners_.fill(std::as_bytes(std::span(ground_plan_.corners)));
  ground_triangles_.fill(std::as_bytes(std::span(ground_plan_.triangles)));
}

void WorldPass::draw_batches(const std::vector<Batch>& batches,
                             const std::array<BodyPipelines, 2>& pipelines) {
  for (const Batch& b : batches) {
    const MeshCache::Entry& mesh = meshes_.get(*b.mesh, frame_);
    const BodyPipelines& p = pipelines[b.patterned];
    DrawCall c = call(b.mesh->ball ? p.ball : b.mesh->two_sided ? p.two_sided : p.closed);
    c.vertices = mesh.vertices;
    c.indices = mesh.indices;
    c.count = mesh.index_count;
    c.instances = instances_.id();
    c.instance_offset = b.first * uint32_t(sizeof(GpuInstance));
    c.instance_count = b.count;
    device_.draw(c);
  }
}

void WorldPass::draw_batches(const std::vector<Batch>& batches, PipelineId closed,
                             PipelineId open) {
  const BodyPipelines all{closed, open, {}};
  draw_batches(batches, {all, all});
}

void WorldPass::draw_spheres(const SphereRun& run, PipelineId pipeline) {
  if (run.count == 0) return;
  DrawCall c = call(pipeline);
  c.vertices = spheres_.id();
  c.first = 3 * run.first;
  c.count = 3 * run.count;
  device_.draw(c);
}

void WorldPass::draw_shadow_passes(const RenderScene& scene, const FrameSetup& setup) {
  device_.begin_pass({targets_->shadow(), {}, true});
  if (setup.shadows) {
    draw_batches(plan_.casters, pipelines_.shadow, pipelines_.shadow_two_sided);
    draw_spheres(plan_.sphere_casters, pipelines_.sphere_shadow);
    draw_spheres(plan_.ball_casters, pipelines_.sphere_shadow);
  }
  device_.end_pass();

  const bool contact = scene.ground.visible && (!plan_.low.empty() || plan_.low_spheres.count > 0);
  const std::array<float, 4> black = {0, 0, 0, 1};
  device_.begin_pass({targets_->contact(0), black, true});
  if (contact) {
    draw_batches(plan_.low, pipelines_.contact, pipelines_.contact);
    draw_spheres(plan_.low_spheres, pipelines_.sphere_contact);
  }
  device_.end_pass();
  if (!contact) return;
  for (const int to : {1, 0}) {
    device_.begin_pass({targets_->contact(to), {}, true});
    DrawCall c = call(to == 1 ? pipelines_.blur_x : pipelines_.blur_y);
    c.textures[0] = targets_->contact_texture(1 - to);
    c.count = 3;
    device_.draw(c);
    device_.end_pass();
  }
}

void WorldPass::draw_ground(uint32_t first, uint32_t count, PipelineId pipeline,
                            const std::optional<ScissorRect>& within) {
  if (count == 0) return;
  DrawCall c = call(pipeline);
  c.vertices = ground_corners_.id();
  c.indices = ground_triangles_.id();
  c.first = first;
  c.count = count;
  c.scissor = within;
  device_.draw(c);
}

/// Writes the depth of the ground, which is blended under the canvas later, to hide what is below
/// it. It uses the same triangles, because bodies may lie in its plane.
void WorldPass::draw_ground_depth(std::span<const ScissorRect> parts) {
  if (parts.empty()) return;
  int left = parts[0].x, right = left, top = parts[0].y, bottom = top;
  for (const ScissorRect& p : parts) {
    left = std::min(left, p.x);
    right = std::max(right, p.x + p.width);
    top = std::min(top, p.y);
    bottom = std::max(bottom, p.y + p.height);
  }
  draw_ground(0, uint32_t(ground_plan_.triangles.size()), pipelines_.ground_depth,
              ScissorRect{left, top, right - left, bottom - top});
}

void WorldPass::draw_bodies(const RenderScene& scene) {
  const size_t fine = scene.quality == Quality::high ? 1 : 0;
  draw_batches(plan_.opaque, pipelines_.bodies[fine]);
  draw_spheres(plan_.opaque_spheres, pipelines_.sphere[fine]);
  draw_batches(plan_.outlined, pipelines_.outline, pipelines_.outline);
}

void WorldPass::draw_background(const RenderScene& scene, const FrameSetup& setup, bool under) {
  if (scene.ground.visible) {
    draw_ground(0, ground_plan_.shaded, pipelines_.ground[under]);
    draw_ground(ground_plan_.shaded, uint32_t(ground_plan_.triangles.size()) - ground_plan_.shaded,
                pipelines_.ground_bare[under]);
  }
  DrawCall sky = call(pipelines_.sky[under]);
  sky.count = 6 * sky_columns * sky_rows;
  const int rows = rows_with_sky(scene, setup);
  if (rows == 0) return;
  sky.scissor = ScissorRect{0, 0, targets_->drawn_width(), rows};
  device_.draw(sky);
}

void WorldPass::draw_blended(const RenderScene& scene) {
  const size_t fine = scene.quality == Quality::high ? 1 : 0;
  draw_batches(plan_.blended, pipelines_.surface_blended[fine], pipelines_.surface_blended[fine]);
  draw_spheres(plan_.blended_spheres, pipelines_.sphere_blended[fine]);
}

/// Enlarges what was drawn with fewer pixels to the size of the picture.
void WorldPass::enlarge() {
  device_.begin_pass({targets_->picture(), {}, false});
  DrawCall c = call(pipelines_.enlarge);
  c.textures[0] = device_.colour_texture(targets_->averaged());
  c.count = 3;
  device_.draw(c);
  device_.end_pass();
}

template <class T>
void WorldPass::draw_marks(const MarkRuns<T>& runs, const StreamBuffer& buffer, PipelineId tested,
                           PipelineId hidden, PipelineId over) {
  uint32_t first = 0;
  const std::array<std::pair<PipelineId, uint32_t>, 3> parts = {
      {{tested, runs.tested}, {hidden, runs.faint}, {over, runs.over}}};
  for (const auto& [pipeline, count] : parts) {
    if (count == 0) continue;
    DrawCall c = call(pipeline);
    c.count = 4;
    c.instances = buffer.id();
    c.instance_offset = first * uint32_t(sizeof(T));
    c.instance_count = count;
    device_.draw(c);
    first += count;
  }
}

/// Draws the depth of solid surfaces for liquids and smoke, single-sampled; the ground costs a
/// tenth of what it costs multisampled.
void WorldPass::draw_solid_depth(const CanvasParts& parts, const Layers& layers) {
  PassDesc pass{soft_.solid(), {}, true};
  pass.depth_of = targets_->canvas();
  pass.depth_parts = parts.solid;
  device_.begin_pass(pass);
  if (layers.ground_under) draw_ground_depth(parts.solid);
  device_.end_pass();
}

/// Draws what needs every sample: edges of bodies, and the ground unless it is blended under them
/// later. Leaves its last pass open.
void WorldPass::draw_canvas(const RenderScene& scene, const FrameSetup& setup,
                            const CanvasParts& parts, const Layers& layers) {
  const TargetId canvas = targets_->canvas();
  const bool soft = scene.has_soft_matter();
  device_.begin_pass({canvas, nothing_drawn, true});
  if (layers.ground_under && scene.ground.visible) draw_ground_depth(parts.below_ground);
  draw_bodies(scene);
  if (!layers.ground_under) draw_background(scene, setup, false);
  if (soft) {
    device_.end_pass();
    draw_solid_depth(parts, layers);
    soft_.draw_liquids(scene, setup, canvas, call({}));
    soft_.draw_smoke(scene, call({}));
    device_.begin_pass({canvas, {}, false});
  }
  draw_blended(scene);
  if (soft && !layers.smoke_last) soft_.cover_with_smoke(call({}));
}

/// Averages the samples of the canvas, and draws what lies over and under all of it.
void WorldPass::draw_averaged(const RenderScene& scene, const FrameSetup& setup,
                              const CanvasParts& parts, const Layers& layers) {
  PassDesc pass{targets_->averaged(), nothing_drawn, false};
  if (!parts.drawn.empty()) {
    pass.averages = targets_->canvas();
    pass.averaged_parts = parts.drawn;
  }
  device_.begin_pass(pass);
  if (scene.has_soft_matter() && layers.smoke_last) soft_.cover_with_smoke(call({}));
  draw_background(scene, setup, true);
  device_.end_pass();
}

/// Turns what was drawn into the final picture: single-sampled, with all pixels.
void WorldPass::finish(bool is_averaged) {
  const PictureTargets& t = *targets_;
  if (t.is_reduced()) {
    if (!is_averaged && t.canvas() != t.averaged()) device_.resolve(t.canvas(), t.averaged());
    enlarge();
  } else if (t.canvas() != t.picture()) {
    const TargetId drawn = is_averaged ? t.averaged() : t.canvas();
    if (drawn != t.picture()) device_.resolve(drawn, t.picture());
  }
}

Result<WorldDrawn> WorldPass::draw(const RenderScene& scene, PictureTargets& targets,
                                   uint64_t frame) {
  targets_ = &targets;
  frame_ = frame;
  const int width = targets.drawn_width(), height = targets.drawn_height();
  const bool soft = scene.has_soft_matter();
  if (soft)
    if (Status s = soft_.prepare(scene, width, height); !s) return s.error();
  const FrameSetup setup = make_frame_setup(scene, width, height);
  make_draw_plan(scene, setup.view, plan_);
  plan_ground(scene, setup, ground_plan_);
  const auto lines = line_runs(scene.lines);
  const auto points = point_runs(scene.points);
  fill_buffers(setup, lines, points);

  draw_shadow_passes(scene, setup);
  if (soft) soft_.plan(scene, setup);
  Layers layers;
  // Liquids refract and so need everything behind them, ground included, in the canvas.
  layers.ground_under =
      targets.canvas() != targets.averaged() && scene.fluids.empty() && rim_is_hidden(scene, setup);
  // Lines and points are drawn over smoke, and the ground hides some of them.
  const bool marks = !lines.all.empty() || !points.all.empty();
  layers.smoke_last = layers.ground_under && !marks;
  const std::vector<ScissorRect> whole = {{0, 0, width, height}};
  CanvasParts parts;
  parts.drawn = marks || !scene.fluids.empty() ? whole : drawn_parts(scene, setup.view);
  parts.below_ground = marks ? whole : sunken_parts(scene, setup.view);
  const auto smoke = soft_.smoke_places();
  parts.solid = scene.fluids.empty() ? std::vector(smoke.begin(), smoke.end()) : whole;
  draw_canvas(scene, setup, parts, layers);
  draw_marks(lines, lines_, pipelines_.line, pipelines_.line_hidden, pipelines_.line_over);
  draw_marks(points, points_, pipelines_.point, pipelines_.point_hidden, pipelines_.point_over);
  device_.end_pass();
  if (layers.ground_under) draw_averaged(scene, setup, parts, layers);
  finish(layers.ground_under);
  return WorldDrawn{setup.camera, plan_.visible, plan_.culled};
}

}  // namespace tumble
