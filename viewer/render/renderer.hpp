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

/// Layout of two pictures of equal width beside each other in one, each with its full height [px].
struct SideBySide {
  int left = 0, right = 0;  ///< x of their left edges
  int width = 1;            ///< width of each
  /// Colour of the parts that neither covers, sRGB 0..1.
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
  /// Adds an image (RGBA) that UiDraw::texture can name.
  virtual UiTextureId add_ui_texture(const Image& image) = 0;

  /// Draws into the renderer's own picture of width x height pixels. Fails if a target cannot be
  /// made or the size is not in 1..16384. Fails with ErrorCode::parse if shaders do not link: the
  /// picture is then complete except for what they draw.
  virtual Result<FrameReport> render(const RenderScene& scene, int width, int height) = 0;
  /// The same with two pictures beside each other; the panels of `left` are drawn over the whole.
  virtual Result<FrameReport> render_beside(const RenderScene& left, const RenderScene& right,
                                            const SideBySide& places, int width, int height) = 0;
  /// Reads the last picture as RGBA. `image` keeps its memory if the size fits.
  virtual Status read_back(Image& image) = 0;
  /// Shows the last picture in the window.
  virtual void present() = 0;

  /// The next picture is drawn completely, even if nothing has changed: see
  /// Device::forget_contents().
  virtual void draw_anew() = 0;

  /// Frees meshes that were not drawn in the last `frames` pictures.
  virtual void forget_unused_meshes(uint32_t frames = 600) = 0;
};

}  // namespace tumble
