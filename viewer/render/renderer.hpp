#pragma once
#include "viewer/render/device.hpp"
#include "viewer/render/font.hpp"
#include "viewer/render/image.hpp"
#include "viewer/render/render_scene.hpp"

#include <array>
#include <filesystem>
#include <memory>

namespace tumble {

/// What one picture cost and contained.
struct FrameReport {
  DrawStats draws;  ///< with the draw-list hash, equal on every device
  uint32_t visible_instances = 0;
  uint32_t culled_instances = 0;
};

/// Where two pictures of equal width stand in one, each as high as that [px].
struct SideBySide {
  int left = 0, right = 0;  ///< their left edges
  int width = 1;            ///< of each
  /// Of what neither covers: red, green, blue as the picture has them.
  std::array<float, 3> around = {0.02f, 0.022f, 0.025f};
};

/// Draws RenderScenes through a Device: shadow, contact shade, surfaces, sky, debug drawing, text
/// and panels, in that order. One thread; the device outlives it.
class Renderer {
 public:
  /// Compiles the shaders of `shader_folder` (resource_path("shaders")). Fails with file and log.
  static Result<std::unique_ptr<Renderer>> create(Device& device,
                                                  const std::filesystem::path& shader_folder);
  virtual ~Renderer() = default;

  /// Replaces the font of labels and of UI texture 0.
  virtual void set_font(const FontAtlas& font) = 0;
  /// A picture for the UI (RGBA), to be named in UiDraw::texture.
  virtual UiTextureId add_ui_texture(const Image& image) = 0;

  /// Draws into the renderer's own picture of width x height pixels. Fails when a target cannot be
  /// made or the size is not in 1..16384. Fails with ErrorCode::parse when shaders do not link:
  /// then the picture is there without what they draw.
  virtual Result<FrameReport> render(const RenderScene& scene, int width, int height) = 0;
  /// The same with two pictures beside each other; the panels are the left one's, over all of it.
  virtual Result<FrameReport> render_beside(const RenderScene& left, const RenderScene& right,
                                            const SideBySide& places, int width, int height) = 0;
  /// The last picture, RGBA. `image` keeps its memory when it fits.
  virtual Status read_back(Image& image) = 0;
  /// The last picture onto the window.
  virtual void present() = 0;

  /// The next picture is drawn whole, also what stands still: see Device::forget_contents().
  virtual void draw_anew() = 0;

  /// Frees meshes not drawn for `frames` pictures.
  virtual void forget_unused_meshes(uint32_t frames = 600) = 0;
};

}  // namespace tumble
