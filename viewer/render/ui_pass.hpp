#pragma once
#include "viewer/render/device.hpp"
#include "viewer/render/font.hpp"
#include "viewer/render/image.hpp"
#include "viewer/render/render_scene.hpp"

#include <span>

namespace tumble {

/// Draws labels and panels over the finished, single-sampled picture.
class UiPass {
 public:
  UiPass(Device& device, PipelineId pipeline, PipelineId place);
  ~UiPass();
  UiPass(const UiPass&) = delete;
  UiPass& operator=(const UiPass&) = delete;

  void set_font(const FontAtlas& font);
  UiTextureId add_texture(const Image& image);
  /// Draws the text of a picture: labels, legends, the plate.
  void draw_words(const RenderScene& scene, const Camera& camera, TargetId target, int width,
                  int height);
  void draw_panels(const UiDrawList& panels, TargetId target, int width, int height);
  /// Position of a picture within another of the same height.
  struct Placed {
    TextureId picture;
    int x = 0, width = 1;  ///< [px]
  };
  /// Clears the target to the colour `around` and draws other pictures into it.
  void place(std::span<const Placed> pictures, const std::array<float, 3>& around, TargetId target,
             int width, int height);

 private:
  void draw_over(const UiDrawList& list, TargetId target, int width, int height);
  void draw_list(const UiDrawList& list, int width, int height);

  Device& device_;
  PipelineId pipeline_, place_;
  FontAtlas font_;
  std::vector<TextureId> textures_;  ///< [0] is the font
  BufferId vertices_, indices_, uniforms_;
  UiDrawList labels_;
};

}  // namespace tumble
