#pragma once
#include "viewer/render/device.hpp"
#include "viewer/render/font.hpp"
#include "viewer/render/image.hpp"
#include "viewer/render/render_scene.hpp"

namespace tumble {

/// Draws labels and panels over the finished picture, one sample a pixel.
class UiPass {
 public:
  UiPass(Device& device, PipelineId pipeline);
  ~UiPass();
  UiPass(const UiPass&) = delete;
  UiPass& operator=(const UiPass&) = delete;

  void set_font(const FontAtlas& font);
  UiTextureId add_texture(const Image& image);
  void draw(const RenderScene& scene, const Camera& camera, TargetId target, int width, int height);

 private:
  void draw_list(const UiDrawList& list, int width, int height);

  Device& device_;
  PipelineId pipeline_;
  FontAtlas font_;
  std::vector<TextureId> textures_;  ///< [0] is the font
  BufferId vertices_, indices_, uniforms_;
  UiDrawList labels_;
};

}  // namespace tumble
