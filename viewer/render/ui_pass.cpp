#include "viewer/render/ui_pass.hpp"

#include "viewer/render/colour_legend.hpp"
#include "viewer/render/gpu_layout.hpp"
#include "viewer/render/labels.hpp"
#include "viewer/render/plate.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

UiPass::UiPass(Device& device, PipelineId pipeline, PipelineId place)
    : device_(device), pipeline_(pipeline), place_(place) {
  textures_.resize(1);
  vertices_ = device_.create_buffer(BufferUse::vertex, 0, {});
  indices_ = device_.create_buffer(BufferUse::index, 0, {});
  uniforms_ = device_.create_buffer(BufferUse::uniform, 0, {});
}

UiPass::~UiPass() {
  for (const TextureId t : textures_)
    if (t) device_.destroy(t);
  for (const BufferId b : {vertices_, indices_, uniforms_}) device_.destroy(b);
}

void UiPass::set_font(const FontAtlas& font) {
  font_ = font;
  std::vector<uint32_t> texels(font.coverage.size());
  for (size_t i = 0; i < texels.size(); ++i)
    texels[i] = 0x00FFFFFFu | uint32_t(font.coverage[i]) << 24;
  if (textures_[0]) device_.destroy(textures_[0]);
  textures_[0] = device_.create_texture(TextureFormat::rgba8_linear_filter, font.width, font.height,
                                        std::as_bytes(std::span(texels)));
}

UiTextureId UiPass::add_texture(const Image& image) {
  textures_.push_back(device_.create_texture(TextureFormat::rgba8_linear_filter, image.width,
                                             image.height, std::as_bytes(std::span(image.pixels))));
  return UiTextureId(textures_.size() - 1);
}

void UiPass::draw_words(const RenderScene& scene, const Camera& camera, TargetId target, int width,
                        int height) {
  labels_.vertices.clear();
  labels_.indices.clear();
  labels_.draws.clear();
  add_labels(scene.texts, font_, camera, width, height, scene.ui_scale, labels_);
  if (!scene.legends.empty())
    add_legends(scene.legends, font_,
                scene.legend_area.value_or(std::array{0.f, 0.f, float(width), float(height)}),
                height, scene.ui_scale, labels_);
  if (scene.plate) add_plate(*scene.plate, font_, width, height, scene.ui_scale, labels_);
  if (!labels_.indices.empty())
    labels_.draws.push_back(
        {0, uint32_t(labels_.indices.size()), 0, {0, 0, float(width), float(height)}, 0});
  draw_over(labels_, target, width, height);
}

void UiPass::draw_panels(const UiDrawList& panels, TargetId target, int width, int height) {
  draw_over(panels, target, width, height);
}

void UiPass::draw_over(const UiDrawList& list, TargetId target, int width, int height) {
  if (list.draws.empty()) return;
  const float w = list.width > 0 ? list.width : float(width);
  const float h = list.height > 0 ? list.height : float(height);
  device_.update_buffer(uniforms_, bytes_of(std::array<float, 4>{w, h, 0, 0}));
  device_.update_buffer(vertices_, std::as_bytes(std::span(list.vertices)));
  device_.update_buffer(indices_, std::as_bytes(std::span(list.indices)));
  device_.begin_pass({target, {}, false});
  draw_list(list, width, height);
  device_.end_pass();
}

void UiPass::place(std::span<const Placed> pictures, const std::array<float, 3>& around,
                   TargetId target, int width, int height) {
  std::vector<UiVertex> corners;
  const auto h = float(height);
  for (const Placed& p : pictures) {
    // Rows of targets are stored bottom first.
    const auto x0 = float(p.x), x1 = float(p.x + p.width);
    const UiVertex a{x0, 0, 0, 1}, b{x1, 0, 1, 1}, c{x1, h, 1, 0}, d{x0, h, 0, 0};
    for (const UiVertex& corner : {a, b, c, a, c, d}) corners.push_back(corner);
  }
  device_.update_buffer(uniforms_, bytes_of(std::array<float, 4>{float(width), h, 0, 0}));
  device_.update_buffer(vertices_, std::as_bytes(std::span(corners)));
  device_.begin_pass({target, std::array{around[0], around[1], around[2], 1.f}, true});
  for (size_t i = 0; i < pictures.size(); ++i) {
    DrawCall c;
    c.pipeline = place_;
    c.vertices = vertices_;
    c.first = uint32_t(6 * i);
    c.count = 6;
    c.textures[0] = pictures[i].picture;
    c.uniforms[0] = {uniforms_, 0, 16};
    device_.draw(c);
  }
  device_.end_pass();
}

void UiPass::draw_list(const UiDrawList& list, int width, int height) {
  const float sx = list.width > 0 ? float(width) / list.width : 1;
  const float sy = list.height > 0 ? float(height) / list.height : 1;
  for (const UiDraw& d : list.draws) {
    const int x0 = std::clamp(int(d.clip[0] * sx), 0, width);
    const int y0 = std::clamp(int(d.clip[1] * sy), 0, height);
    const int x1 = std::clamp(int(d.clip[2] * sx), 0, width);
    const int y1 = std::clamp(int(d.clip[3] * sy), 0, height);
    if (x1 <= x0 || y1 <= y0 || d.index_count == 0) continue;
    DrawCall c;
    c.pipeline = pipeline_;
    c.vertices = vertices_;
    c.indices = indices_;
    c.first = d.first_index;
    c.count = d.index_count;
    c.base_vertex = int32_t(d.base_vertex);
    c.textures[0] = d.texture < textures_.size() ? textures_[d.texture] : TextureId{};
    c.uniforms[0] = {uniforms_, 0, 16};
    c.scissor = ScissorRect{x0, y0, x1 - x0, y1 - y0};
    device_.draw(c);
  }
}

}  // namespace tumble
