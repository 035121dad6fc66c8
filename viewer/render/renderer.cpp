#include "viewer/render/renderer.hpp"

#include "viewer/render/background.hpp"
#include "viewer/render/drawn_area.hpp"
#include "viewer/render/frame_setup.hpp"
#include "viewer/render/ground_plan.hpp"
#include "viewer/render/marks.hpp"
#include "viewer/render/mesh_cache.hpp"
#include "viewer/render/picture_targets.hpp"
#include "viewer/render/pipelines.hpp"
#include "viewer/render/soft_pass.hpp"
#include "viewer/render/ui_pass.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tumble {
namespace {

/// A buffer that is refilled every frame.
class StreamBuffer {
 public:
  StreamBuffer(Device& device, BufferUse use)
      : device_(device), id_(device.create_buffer(use, 0, {})) {}
  ~StreamBuffer() { device_.destroy(id_); }
  StreamBuffer(const StreamBuffer&) = delete;
  StreamBuffer& operator=(const StreamBuffer&) = delete;
  void fill(std::span<const std::byte> data) { device_.update_buffer(id_, data); }
  BufferId id() const { return id_; }

 private:
  Device& device_;
  BufferId id_;
};

/// A canvas that leaves all of what lies under it.
constexpr std::array<float, 4> nothing_drawn = {0, 0, 0, 1};

class RendererImpl final : public Renderer {
 public:
  RendererImpl(Device& device, const Pipelines& pipelines)
      : device_(device),
        pipelines_(pipelines),
        meshes_(device),
        targets_(device),
        beside_(device),
        ui_(device, pipelines.ui, pipelines.place),
        soft_(device, pipelines_),
        frame_uniforms_(device, BufferUse::uniform),
        instances_(device, BufferUse::vertex),
        spheres_(device, BufferUse::vertex),
        lines_(device, BufferUse::vertex),
        points_(device, BufferUse::vertex),
        ground_corners_(device, BufferUse::vertex),
        ground_triangles_(device, BufferUse::index) {
    set_font(bake_default_font());
  }
  ~RendererImpl() override {
    if (whole_.target) device_.destroy(whole_.target);
    pipelines_.destroy(device_);
  }

  void set_font(const FontAtlas& font) override { ui_.set_font(font); }
  UiTextureId add_ui_texture(const Image& image) override { return ui_.add_texture(image); }

  Result<FrameReport> render(const RenderScene& scene, int width, int height) override;
  Result<FrameReport> render_beside(const RenderScene& left, const RenderScene& right,
                                    const SideBySide& places, int width, int height) override;

  Status read_back(Image& image) override {
    if (!shown_.target)
      return Error{ErrorCode::invalid_argument, "nothing has been drawn yet", "read_back", ""};
    image.width = shown_.width;
    image.height = shown_.height;
    image.channels = 4;
    image.pixels.resize(size_t(image.width) * size_t(image.height) * 4);
    device_.read_pixels(shown_.target, image.pixels);
    for (size_t i = 3; i < image.pixels.size(); i += 4) image.pixels[i] = 255;
    return check_device("reading the picture back");
  }
  void present() override {
    if (shown_.target) device_.present(shown_.target);
  }
  void draw_anew() override { device_.forget_contents(); }
  void forget_unused_meshes(uint32_t frames) override {
    if (frame_ > frames) meshes_.forget_before(frame_ - frames);
  }

 private:
  /// What read_back() and present() take.
  struct Finished {
    TargetId target;
    int width = 0, height = 0;  ///< [px]
  };

  DrawCall call(PipelineId pipeline) const {
    DrawCall c;
    c.pipeline = pipeline;
    c.uniforms[0] = {frame_uniforms_.id(), 0, sizeof(GpuFrame)};
    c.textures = {targets_now_->shadow_map(), targets_now_->contact_map()};
    return c;
  }
  /// Balls come in the opaque layer only.
  void draw_batches(const std::vector<Batch>& batches, PipelineId closed, PipelineId open,
                    PipelineId ball = {});
  void draw_spheres(const SphereRun& run, PipelineId pipeline);
  void draw_shadow_passes(const RenderScene& scene, const FrameSetup& setup);
  void draw_ground(uint32_t first, uint32_t count, PipelineId pipeline,
                   const std::optional<ScissorRect>& within = {});
  void draw_bodies(const RenderScene& scene);
  void draw_background(const RenderScene& scene, const FrameSetup& setup, bool under);
  void draw_canvas(const RenderScene& scene, const FrameSetup& setup, bool under, bool smoke_last);
  void finish_world(bool is_averaged);
  Status draw_world(const RenderScene& scene, PictureTargets& targets, FrameReport& report);
  Status prepare_whole(int width, int height);
  Result<FrameReport> finish_picture(const UiDrawList& panels, const Finished& picture,
                                     FrameReport report);
  void draw_blended(const RenderScene& scene);
  void enlarge();
  template <class T>
  void draw_marks(const MarkRuns<T>& runs, const StreamBuffer& buffer, PipelineId tested,
                  PipelineId hidden, PipelineId over);
  Status check_device(const char* doing) {
    const auto faults = device_.take_faults();
    if (faults.empty()) return {};
    return Error{ErrorCode::internal, fmt::format("{}: {}", doing, fmt::join(faults, "; ")),
                 device_.info().renderer, "update the driver, or try another --context"};
  }

  Device& device_;
  Pipelines pipelines_;
  MeshCache meshes_;
  PictureTargets targets_, beside_;  ///< of the picture, or the left and the right one
  Finished whole_;                   ///< of both beside each other
  Finished shown_;
  PictureTargets* targets_now_ = &targets_;  ///< being drawn into
  UiPass ui_;
  SoftPass soft_;
  StreamBuffer frame_uniforms_, instances_, spheres_, lines_, points_;
  StreamBuffer ground_corners_, ground_triangles_;
  DrawPlan plan_;
  GroundPlan ground_plan_;
  /// What of the canvas is looked at where ground and sky come under it; none: nothing.
  std::optional<ScissorRect> canvas_area_;
  uint64_t frame_ = 0;
};

void RendererImpl::draw_batches(const std::vector<Batch>& batches, PipelineId closed,
                                PipelineId open, PipelineId ball) {
  for (const Batch& b : batches) {
    const MeshCache::Entry& mesh = meshes_.get(*b.mesh, frame_);
    DrawCall c = call(b.mesh->ball ? ball : b.mesh->two_sided ? open : closed);
    c.vertices = mesh.vertices;
    c.indices = mesh.indices;
    c.count = mesh.index_count;
    c.instances = instances_.id();
    c.instance_offset = b.first * uint32_t(sizeof(GpuInstance));
    c.instance_count = b.count;
    device_.draw(c);
  }
}

void RendererImpl::draw_spheres(const SphereRun& run, PipelineId pipeline) {
  if (run.count == 0) return;
  DrawCall c = call(pipeline);
  c.vertices = spheres_.id();
  c.first = 3 * run.first;
  c.count = 3 * run.count;
  device_.draw(c);
}

void RendererImpl::draw_shadow_passes(const RenderScene& scene, const FrameSetup& setup) {
  device_.begin_pass({targets_now_->shadow(), {}, true});
  if (setup.shadows) {
    draw_batches(plan_.casters, pipelines_.shadow, pipelines_.shadow_two_sided);
    draw_spheres(plan_.sphere_casters, pipelines_.sphere_shadow);
  }
  device_.end_pass();

  const bool contact = scene.ground.visible && (!plan_.low.empty() || plan_.low_spheres.count > 0);
  const std::array<float, 4> black = {0, 0, 0, 1};
  device_.begin_pass({targets_now_->contact(0), black, true});
  if (contact) {
    draw_batches(plan_.low, pipelines_.contact, pipelines_.contact);
    draw_spheres(plan_.low_spheres, pipelines_.sphere_contact);
  }
  device_.end_pass();
  if (!contact) return;
  for (const int to : {1, 0}) {
    device_.begin_pass({targets_now_->contact(to), {}, true});
    DrawCall c = call(to == 1 ? pipelines_.blur_x : pipelines_.blur_y);
    c.textures[0] = targets_now_->contact_texture(1 - to);
    c.count = 3;
    device_.draw(c);
    device_.end_pass();
  }
}

void RendererImpl::draw_ground(uint32_t first, uint32_t count, PipelineId pipeline,
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

void RendererImpl::draw_bodies(const RenderScene& scene) {
  const size_t fine = scene.quality == Quality::high ? 1 : 0;
  draw_batches(plan_.opaque, pipelines_.surface[fine], pipelines_.surface_two_sided[fine],
               pipelines_.ball[fine]);
  draw_spheres(plan_.opaque_spheres, pipelines_.sphere[fine]);
  draw_batches(plan_.outlined, pipelines_.outline, pipelines_.outline);
}

void RendererImpl::draw_background(const RenderScene& scene, const FrameSetup& setup, bool under) {
  if (scene.ground.visible) {
    draw_ground(0, ground_plan_.shaded, pipelines_.ground[under]);
    draw_ground(ground_plan_.shaded, uint32_t(ground_plan_.triangles.size()) - ground_plan_.shaded,
                pipelines_.ground_bare[under]);
  }
  DrawCall sky = call(pipelines_.sky[under]);
  sky.count = 6 * sky_columns * sky_rows;
  const int rows = rows_with_sky(scene, setup);
  if (rows == 0) return;
  sky.scissor = ScissorRect{0, 0, targets_now_->drawn_width(), rows};
  device_.draw(sky);
}

void RendererImpl::draw_blended(const RenderScene& scene) {
  const size_t fine = scene.quality == Quality::high ? 1 : 0;
  draw_batches(plan_.blended, pipelines_.surface_blended[fine], pipelines_.surface_blended[fine]);
  draw_spheres(plan_.blended_spheres, pipelines_.sphere_blended[fine]);
}

/// What was drawn with fewer pixels than the picture has.
void RendererImpl::enlarge() {
  device_.begin_pass({targets_now_->picture(), {}, false});
  DrawCall c = call(pipelines_.enlarge);
  c.textures[0] = device_.colour_texture(targets_now_->averaged());
  c.count = 3;
  device_.draw(c);
  device_.end_pass();
}

template <class T>
void RendererImpl::draw_marks(const MarkRuns<T>& runs, const StreamBuffer& buffer,
                              PipelineId tested, PipelineId hidden, PipelineId over) {
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

/// What needs every sample: edges of bodies, and the ground too unless it comes `under` them later.
/// Leaves its last pass open.
void RendererImpl::draw_canvas(const RenderScene& scene, const FrameSetup& setup, bool under,
                               bool smoke_last) {
  const TargetId canvas = targets_now_->canvas();
  const bool soft = scene.has_soft_matter();
  device_.begin_pass({canvas, nothing_drawn, true});
  if (under && scene.ground.visible && canvas_area_)
    draw_ground(0, uint32_t(ground_plan_.triangles.size()), pipelines_.ground_depth, canvas_area_);
  draw_bodies(scene);
  if (!under) draw_background(scene, setup, false);
  if (soft) {
    device_.end_pass();
    soft_.draw_liquids(scene, setup, canvas, call({}));
    soft_.draw_smoke(scene, setup, call({}));
    device_.begin_pass({canvas, {}, false});
  }
  draw_blended(scene);
  if (soft && !smoke_last) soft_.cover_with_smoke(call({}));
}

/// From what was drawn to the picture, of one sample and with all its pixels.
void RendererImpl::finish_world(bool is_averaged) {
  const PictureTargets& t = *targets_now_;
  if (t.is_reduced()) {
    if (!is_averaged && t.canvas() != t.averaged()) device_.resolve(t.canvas(), t.averaged());
    enlarge();
  } else if (t.canvas() != t.picture()) {
    device_.resolve(is_averaged ? t.averaged() : t.canvas(), t.picture());
  }
}

/// The world and its words, into targets that were prepared.
Status RendererImpl::draw_world(const RenderScene& scene, PictureTargets& targets,
                                FrameReport& report) {
  targets_now_ = &targets;
  const int width = targets.drawn_width(), height = targets.drawn_height();
  const bool soft = scene.has_soft_matter();
  if (soft)
    if (Status s = soft_.prepare(width, height, scene.quality); !s) return s;
  const FrameSetup setup = make_frame_setup(scene, width, height);
  make_draw_plan(scene, setup.view, plan_);
  plan_ground(scene, setup, ground_plan_);
  const auto lines = line_runs(scene.lines);
  const auto points = point_runs(scene.points);
  frame_uniforms_.fill(bytes_of(setup.uniforms));
  instances_.fill(std::as_bytes(std::span(plan_.instances)));
  spheres_.fill(std::as_bytes(std::span(plan_.sphere_vertices)));
  lines_.fill(std::as_bytes(std::span(lines.all)));
  points_.fill(std::as_bytes(std::span(points.all)));
  ground_corners_.fill(std::as_bytes(std::span(ground_plan_.corners)));
  ground_triangles_.fill(std::as_bytes(std::span(ground_plan_.triangles)));

  draw_shadow_passes(scene, setup);
  // Liquids look through to what is behind them.
  const bool under =
      targets.canvas() != targets.averaged() && scene.fluids.empty() && rim_is_hidden(scene, setup);
  // Marks lie over smoke.
  const bool smoke_last = under && lines.all.empty() && points.all.empty();
  canvas_area_ = ScissorRect{0, 0, width, height};
  if (smoke_last && !soft) canvas_area_ = drawn_area(scene, setup.view);
  draw_canvas(scene, setup, under, smoke_last);
  draw_marks(lines, lines_, pipelines_.line, pipelines_.line_hidden, pipelines_.line_over);
  draw_marks(points, points_, pipelines_.point, pipelines_.point_hidden, pipelines_.point_over);
  device_.end_pass();
  if (under) {
    PassDesc pass{targets.averaged(), nothing_drawn, false};
    if (canvas_area_) {
      pass.averages = targets.canvas();
      pass.averaged_area = *canvas_area_;
    }
    device_.begin_pass(pass);
    if (soft && smoke_last) soft_.cover_with_smoke(call({}));
    draw_background(scene, setup, true);
    device_.end_pass();
  }
  finish_world(under);
  ui_.draw_words(scene, setup.camera, targets.picture(), targets.width(), targets.height());
  report.visible_instances += plan_.visible;
  report.culled_instances += plan_.culled;
  return {};
}

Result<FrameReport> RendererImpl::finish_picture(const UiDrawList& panels, const Finished& picture,
                                                 FrameReport report) {
  shown_ = picture;
  ui_.draw_panels(panels, picture.target, picture.width, picture.height);
  report.draws = device_.stats();
  if (Status s = check_device("drawing"); !s) return s.error();
  if (Status s = device_.take_link_failure(); !s) return s.error();
  return report;
}

Result<FrameReport> RendererImpl::render(const RenderScene& scene, int width, int height) {
  shown_ = {};
  if (Status s = targets_.prepare(width, height, scene.resolution, values_of(scene.quality)); !s)
    return s.error();
  ++frame_;
  device_.begin_frame();
  FrameReport report;
  if (Status s = draw_world(scene, targets_, report); !s) return s.error();
  return finish_picture(scene.ui, {targets_.picture(), width, height}, report);
}

/// A target of the picture that is put together of two.
Status RendererImpl::prepare_whole(int width, int height) {
  if (whole_.target && width == whole_.width && height == whole_.height) return {};
  if (whole_.target) device_.destroy(whole_.target);
  whole_ = {};
  TargetDesc d;
  d.width = width;
  d.height = height;
  d.depth = DepthAttachment::none;
  auto made = device_.create_target(d);
  if (!made) return made.error();
  whole_ = {*made, width, height};
  return {};
}

Result<FrameReport> RendererImpl::render_beside(const RenderScene& left, const RenderScene& right,
                                                const SideBySide& places, int width, int height) {
  shown_ = {};
  for (const auto& [scene, targets] : {std::pair(&left, &targets_), std::pair(&right, &beside_)})
    if (Status s =
            targets->prepare(places.width, height, scene->resolution, values_of(scene->quality));
        !s)
      return s.error();
  if (Status s = prepare_whole(width, height); !s) return s.error();
  ++frame_;
  device_.begin_frame();
  FrameReport report;
  if (Status s = draw_world(left, targets_, report); !s) return s.error();
  if (Status s = draw_world(right, beside_, report); !s) return s.error();
  const auto picture_of = [&](const PictureTargets& t) {
    return device_.colour_texture(t.picture());
  };
  ui_.place(std::array{UiPass::Placed{picture_of(targets_), places.left, places.width},
                       UiPass::Placed{picture_of(beside_), places.right, places.width}},
            places.around, whole_.target, width, height);
  return finish_picture(left.ui, whole_, report);
}

}  // namespace

Result<std::unique_ptr<Renderer>> Renderer::create(Device& device,
                                                   const std::filesystem::path& shader_folder) {
  auto pipelines = Pipelines::create(device, shader_folder);
  if (!pipelines) return pipelines.error();
  return std::unique_ptr<Renderer>(std::make_unique<RendererImpl>(device, *pipelines));
}

}  // namespace tumble
