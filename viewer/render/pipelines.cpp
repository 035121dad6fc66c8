#include "viewer/render/pipelines.hpp"

#include "viewer/render/gpu_layout.hpp"
#include "viewer/render/shader_source.hpp"

namespace tumble {
namespace {

PipelineDesc surface_desc() {
  PipelineDesc d;
  d.attributes = {{0, 0, AttributeType::f32, 3, 0},  {1, 0, AttributeType::f32, 3, 12},
                  {2, 1, AttributeType::f32, 4, 0},  {3, 1, AttributeType::f32, 4, 16},
                  {4, 1, AttributeType::f32, 4, 32}, {5, 1, AttributeType::f32, 4, 48},
                  {6, 1, AttributeType::f32, 4, 64}, {7, 1, AttributeType::f32, 4, 80}};
  d.stride = {sizeof(GpuVertex), sizeof(GpuInstance)};
  d.uniform_blocks = {"Frame"};
  return d;
}

PipelineDesc sphere_desc() {
  PipelineDesc d;
  d.attributes = {{0, 0, AttributeType::f32, 4, 0}, {1, 0, AttributeType::f32, 4, 16}};
  d.stride = {sizeof(GpuSphere), 0};
  d.uniform_blocks = {"Frame"};
  d.cull = Cull::none;
  return d;
}

PipelineDesc screen_desc() {
  PipelineDesc d;
  d.depth_test = DepthTest::none;
  d.depth_write = false;
  d.cull = Cull::none;
  d.covers_target = true;
  return d;
}

PipelineDesc mark_desc(bool line, DepthTest test) {
  PipelineDesc d;
  d.topology = Topology::triangle_strip;
  d.blend = Blend::alpha;
  d.depth_test = test;
  d.depth_write = false;
  d.cull = Cull::none;
  d.uniform_blocks = {"Frame"};
  if (line) {
    d.attributes = {{0, 1, AttributeType::f32, 3, 0},
                    {1, 1, AttributeType::f32, 3, 12},
                    {2, 1, AttributeType::f32, 4, 24},
                    {3, 1, AttributeType::f32, 1, 40}};
    d.stride = {0, sizeof(GpuLine)};
  } else {
    d.attributes = {{0, 1, AttributeType::f32, 3, 0},
                    {1, 1, AttributeType::f32, 4, 12},
                    {2, 1, AttributeType::f32, 1, 28}};
    d.stride = {0, sizeof(GpuPoint)};
  }
  return d;
}

PipelineDesc ui_desc() {
  PipelineDesc d = screen_desc();
  d.covers_target = false;
  d.attributes = {{0, 0, AttributeType::f32, 2, 0},
                  {1, 0, AttributeType::f32, 2, 8},
                  {2, 0, AttributeType::u8_unorm, 4, 16}};
  d.stride = {20, 0};
  d.blend = Blend::alpha;
  d.textures = {"image"};
  d.uniform_blocks = {"Ui"};
  return d;
}

PipelineDesc soft_screen_desc(std::vector<std::string> textures) {
  PipelineDesc d = screen_desc();
  d.uniform_blocks = {"Frame", "Soft"};
  d.textures = std::move(textures);
  return d;
}

PipelineDesc puff_desc() {
  PipelineDesc d = soft_screen_desc({"shadow_map", "puffs", "scene_depth"});
  d.topology = Topology::triangle_strip;
  d.attributes = {{0, 1, AttributeType::f32, 4, 0},
                  {1, 1, AttributeType::f32, 4, 16},
                  {2, 1, AttributeType::f32, 4, 32},
                  {3, 1, AttributeType::f32, 2, 48}};
  d.stride = {0, sizeof(GpuPuff)};
  d.blend = Blend::premultiplied;
  d.covers_target = false;
  return d;
}

/// Makes pipelines until one fails; then the rest are skipped.
class Maker {
 public:
  Maker(const Pipelines::Make& make, const std::filesystem::path& folder)
      : make_(make), sources_(folder) {}

  PipelineId make(const char* name, PipelineDesc desc, const char* vertex, const char* fragment) {
    if (!status_) return {};
    auto v = sources_.load(vertex);
    if (!v) return fail(v.error());
    auto f = sources_.load(fragment);
    if (!f) return fail(f.error());
    desc.name = name;
    desc.vertex_source = std::move(*v);
    desc.fragment_source = std::move(*f);
    auto id = make_(desc);
    if (!id) return fail(id.error());
    return *id;
  }
  const Status& status() const { return status_; }

 private:
  PipelineId fail(const Error& e) {
    status_ = e;
    return {};
  }
  const Pipelines::Make& make_;
  ShaderSources sources_;
  Status status_;
};

BodyPipelines make_bodies(Maker& maker, size_t fine, size_t patterned) {
  constexpr const char* surface[2][2] = {{"surface.frag", "surface_patterned.frag"},
                                         {"surface_fine.frag", "surface_fine_patterned.frag"}};
  constexpr const char* ball[2][2] = {{"ball.frag", "ball_patterned.frag"},
                                      {"ball_fine.frag", "ball_fine_patterned.frag"}};
  BodyPipelines p;
  PipelineDesc d = surface_desc();
  d.textures = {"shadow_map", "contact_map"};
  p.closed = maker.make("surface", d, "surface.vert", surface[fine][patterned]);
  d.cull = Cull::none;
  p.two_sided = maker.make("surface_two_sided", d, "surface.vert", surface[fine][patterned]);
  d.alpha_to_coverage = true;
  p.ball = maker.make("ball", d, "ball.vert", ball[fine][patterned]);
  return p;
}

/// Of liquids and smoke.
void make_soft(Maker& maker, Pipelines& p) {
  PipelineDesc d = soft_screen_desc({"shadow_map", "scene_depth", "sun_veil"});
  d.blend = Blend::multiply;
  p.veil_shade = maker.make("veil_shade", d, "veil_shade.vert", "veil_shade.frag");
  d.blend = Blend::none;
  d.covers_target = false;  // what the veil cannot reach is left out
  p.veil_layer = maker.make("veil_layer", d, "veil_shade.vert", "veil_layer.frag");
  d = soft_screen_desc({"source"});
  p.narrow_range_x = maker.make("narrow_range_x", d, "screen.vert", "narrow_range_x.frag");
  p.narrow_range_y = maker.make("narrow_range_y", d, "screen.vert", "narrow_range_y.frag");
  d = sphere_desc();
  d.attributes = {{0, 0, AttributeType::f32, 4, 0},
                  {1, 0, AttributeType::f32, 3, 16},
                  {2, 0, AttributeType::f32, 3, 28},
                  {3, 0, AttributeType::f32, 1, 40}};
  d.stride = {sizeof(GpuFluidParticle), 0};
  d.uniform_blocks = {"Frame", "Soft"};
  p.fluid_depth = maker.make("fluid_depth", d, "fluid_ball.vert", "fluid_depth.frag");
  d.textures = {"scene_depth", "front"};
  d.depth_test = DepthTest::none;
  d.depth_write = false;
  d.blend = Blend::add;
  p.fluid_thickness = maker.make("fluid_thickness", d, "fluid_ball.vert", "fluid_thickness.frag");
  d = soft_screen_desc({"shadow_map", "front", "thickness", "scene", "scene_depth"});
  d.depth_test = DepthTest::less_equal;
  d.depth_write = true;
  p.fluid_surface = maker.make("fluid_surface", d, "screen.vert", "fluid_surface.frag");
  p.smoke = maker.make("smoke", puff_desc(), "smoke.vert", "smoke.frag");
  d = soft_screen_desc({"smoke", "scene_depth"});
  d.blend = Blend::premultiplied;
  p.smoke_cover = maker.make("smoke_cover", d, "smoke_cover.vert", "smoke_cover.frag");
}

}  // namespace

Status Pipelines::make_all(const Make& make, const std::filesystem::path& folder) {
  Pipelines& p = *this;
  Maker maker(make, folder);
  PipelineDesc d;
  for (const size_t fine : {0u, 1u}) {
    for (const size_t patterned : {0u, 1u})
      p.bodies[fine][patterned] = make_bodies(maker, fine, patterned);
    d = surface_desc();
    d.textures = {"shadow_map", "contact_map"};
    d.cull = Cull::none;
    d.blend = Blend::premultiplied;
    d.depth_write = false;
    p.surface_blended[fine] =
        maker.make("surface_blended", d, "surface.vert", fine ? "glass_fine.frag" : "glass.frag");
  }
  for (const size_t fine : {0u, 1u}) {
    const char* fragment = fine ? "sphere_fine.frag" : "sphere.frag";
    d = sphere_desc();
    d.textures = {"shadow_map", "contact_map"};
    d.alpha_to_coverage = true;
    p.sphere[fine] = maker.make("sphere", d, "sphere.vert", fragment);
    d.alpha_to_coverage = false;
    d.blend = Blend::alpha;
    d.depth_write = false;
    p.sphere_blended[fine] = maker.make("sphere_blended", d, "sphere.vert", fragment);
  }
  d = surface_desc();
  d.cull = Cull::front;
  p.outline = maker.make("outline", d, "surface.vert", "outline.frag");

  d = surface_desc();
  d.colour_write = false;
  d.depth_slope_bias = 1.5f;
  d.depth_bias = 2;
  p.shadow = maker.make("shadow", d, "shadow.vert", "shadow.frag");
  d.cull = Cull::none;
  p.shadow_two_sided = maker.make("shadow_two_sided", d, "shadow.vert", "shadow.frag");
  d = sphere_desc();
  d.colour_write = false;
  p.sphere_shadow = maker.make("sphere_shadow", d, "sphere_shadow.vert", "sphere_shadow.frag");
  d = surface_desc();
  d.cull = Cull::none;
  p.contact = maker.make("contact", d, "contact.vert", "contact.frag");
  d = sphere_desc();
  p.sphere_contact = maker.make("sphere_contact", d, "sphere_contact.vert", "sphere_contact.frag");
  d = screen_desc();
  d.textures = {"source"};
  p.blur_x = maker.make("blur_x", d, "screen.vert", "blur_x.frag");
  p.blur_y = maker.make("blur_y", d, "screen.vert", "blur_y.frag");

  p.enlarge = maker.make("enlarge", d, "screen.vert", "enlarge.frag");

  d = {};
  d.cull = Cull::front;
  d.attributes = {{0, 0, AttributeType::f32, 2, 0}};
  d.stride = {2 * sizeof(float), 0};
  d.uniform_blocks = {"Frame"};
  d.colour_write = false;
  p.ground_depth = maker.make("ground_depth", d, "ground_depth.vert", "shadow.frag");
  d.colour_write = true;
  for (const bool under : {false, true}) {
    if (under) {
      d.depth_test = DepthTest::none;
      d.depth_write = false;
      d.blend = Blend::under;
    }
    d.textures = {};
    p.ground_bare[under] = maker.make("ground_bare", d, "ground_bare.vert", "ground_bare.frag");
    d.textures = {"shadow_map", "contact_map"};
    p.ground[under] = maker.make("ground", d, "ground.vert", "ground.frag");
  }
  d = screen_desc();
  d.covers_target = false;
  d.uniform_blocks = {"Frame"};
  d.blend = Blend::under;
  p.sky[1] = maker.make("sky", d, "sky.vert", "sky.frag");
  d.blend = Blend::none;
  d.depth_test = DepthTest::less_equal;
  p.sky[0] = maker.make("sky", d, "sky.vert", "sky.frag");

  for (const bool line : {true, false}) {
    const char* vertex = line ? "line.vert" : "point.vert";
    const char* fragment = line ? "line.frag" : "point.frag";
    const auto mark = [&](const char* name, DepthTest test) {
      return maker.make(name, mark_desc(line, test), vertex, fragment);
    };
    (line ? p.line : p.point) = mark(line ? "line" : "point", DepthTest::less_equal);
    (line ? p.line_hidden : p.point_hidden) =
        mark(line ? "line_hidden" : "point_hidden", DepthTest::greater);
    (line ? p.line_over : p.point_over) = mark(line ? "line_over" : "point_over", DepthTest::none);
  }
  make_soft(maker, p);
  p.ui = maker.make("ui", ui_desc(), "ui.vert", "ui.frag");
  d = ui_desc();
  d.blend = Blend::none;
  p.place = maker.make("place", d, "ui.vert", "place.frag");
  return maker.status();
}

Result<Pipelines> Pipelines::create(Device& device, const std::filesystem::path& folder) {
  Pipelines p;
  const Make make = [&](const PipelineDesc& desc) { return device.create_pipeline(desc); };
  if (Status made = p.make_all(make, folder); !made) {
    p.destroy(device);
    return made.error();
  }
  return p;
}

void Pipelines::destroy(Device& device) {
  for (auto& shading : bodies)
    for (BodyPipelines& b : shading)
      for (PipelineId* id : {&b.closed, &b.two_sided, &b.ball}) {
        if (*id) device.destroy(*id);
        *id = {};
      }
  for (PipelineId* id : {&surface_blended[0],
                         &surface_blended[1],
                         &sphere[0],
                         &sphere[1],
                         &sphere_blended[0],
                         &sphere_blended[1],
                         &outline,
                         &shadow,
                         &shadow_two_sided,
                         &sphere_shadow,
                         &contact,
                         &sphere_contact,
                         &blur_x,
                         &blur_y,
                         &enlarge,
                         &ground_depth,
                         &ground[0],
                         &ground[1],
                         &ground_bare[0],
                         &ground_bare[1],
                         &sky[0],
                         &sky[1],
                         &line,
                         &line_hidden,
                         &line_over,
                         &point,
                         &point_hidden,
                         &point_over,
                         &place,
                         &veil_shade,
                         &veil_layer,
                         &fluid_depth,
                         &narrow_range_x,
                         &narrow_range_y,
                         &fluid_thickness,
                         &fluid_surface,
                         &smoke,
                         &smoke_cover,
                         &ui}) {
    if (*id) device.destroy(*id);
    *id = {};
  }
}

}  // namespace tumble
