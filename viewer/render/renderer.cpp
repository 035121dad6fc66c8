#include "viewer/render/renderer.hpp"

#include "viewer/render/picture_targets.hpp"
#include "viewer/render/pipelines.hpp"
#include "viewer/render/ui_pass.hpp"
#include "viewer/render/world_pass.hpp"

#include <array>
#include <bit>
#include <cstring>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Whether words are drawn over the world.
bool has_words(const RenderScene& scene) {
  return !scene.texts.empty() || !scene.legends.empty() || scene.plate;
}

/// Sets the alpha of all pixels, by words: by bytes it takes several times as long.
void make_opaque(std::span<uint8_t> rgba) {
  constexpr auto opaque = std::bit_cast<uint32_t>(std::array<uint8_t, 4>{0, 0, 0, 255});
  for (size_t i = 0; i + 4 <= rgba.size(); i += 4) {
    uint32_t pixel = 0;
    std::memcpy(&pixel, rgba.data() + i, 4);
    pixel |= opaque;
    std::memcpy(rgba.data() + i, &pixel, 4);
  }
}

class RendererImpl final : public Renderer {
 public:
  RendererImpl(Device& device, const Pipelines& pipelines)
      : device_(device),
        pipelines_(pipelines),
        targets_(device),
        beside_(device),
        ui_(device, pipelines.ui, pipelines.place),
        world_(device, pipelines_) {
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
    make_opaque(image.pixels);
    return check_device("reading the picture back");
  }
  void present() override {
    if (shown_.target) device_.present(shown_.target);
  }
  void draw_anew() override { device_.forget_contents(); }
  void forget_unused_meshes(uint32_t frames) override {
    if (frame_ > frames) world_.forget_meshes_before(frame_ - frames);
  }

 private:
  /// The picture that read_back() and present() use.
  struct Finished {
    TargetId target;
    int width = 0, height = 0;  ///< [px]
  };

  /// Draws the world and its text into prepared targets.
  Status draw_world(const RenderScene& scene, PictureTargets& targets, FrameReport& report);
  Status prepare_whole(int width, int height);
  Result<FrameReport> finish_picture(const UiDrawList& panels, const Finished& picture,
                                     FrameReport report);
  Status check_device(const char* doing) {
    const auto faults = device_.take_faults();
    if (faults.empty()) return {};
    return Error{ErrorCode::internal, fmt::format("{}: {}", doing, fmt::join(faults, "; ")),
                 device_.info().renderer, "update the driver, or try another --context"};
  }

  Device& device_;
  Pipelines pipelines_;
  PictureTargets targets_, beside_;  ///< for the single or left picture, and for the right one
  Finished whole_;                   ///< the two pictures beside each other
  Finished shown_;
  UiPass ui_;
  WorldPass world_;
  uint64_t frame_ = 0;
};

Status RendererImpl::draw_world(const RenderScene& scene, PictureTargets& targets,
                                FrameReport& report) {
  const auto drawn = world_.draw(scene, targets, frame_);
  if (!drawn) return drawn.error();
  ui_.draw_words(scene, drawn->camera, targets.picture(), targets.width(), targets.height());
  report.visible_instances += drawn->visible_instances;
  report.culled_instances += drawn->culled_instances;
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
  const bool covered = has_words(scene) || !scene.ui.draws.empty();
  if (Status s =
          targets_.prepare(width, height, scene.resolution, values_of(scene.quality), covered);
      !s)
    return s.error();
  ++frame_;
  device_.begin_frame();
  FrameReport report;
  if (Status s = draw_world(scene, targets_, report); !s) return s.error();
  return finish_picture(scene.ui, {targets_.picture(), width, height}, report);
}

/// Makes the target in which two pictures are put together.
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
    if (Status s = targets->prepare(places.width, height, scene->resolution,
                                    values_of(scene->quality), has_words(*scene));
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
