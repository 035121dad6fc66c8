#pragma once
#include "viewer/render/device.hpp"

#include <array>
#include <filesystem>
#include <functional>

namespace tumble {

/// Pipelines for bodies: closed meshes, open ones, and balls drawn as impostors.
struct BodyPipelines {
  PipelineId closed, two_sided, ball;
};

/// Every pipeline of the renderer. Bindings: textures shadow_map, contact_map (or image, source);
/// uniform blocks Frame (or Ui).
struct Pipelines {
  /// First index: [0] cheap shading, [1] fine. Second index for bodies: [0] plain, [1] with a
  /// pattern. Two shaders, because a software renderer also pays for branches that are not taken.
  std::array<std::array<BodyPipelines, 2>, 2> bodies;
  std::array<PipelineId, 2> surface_blended;
  std::array<PipelineId, 2> sphere, sphere_blended;
  PipelineId outline;
  PipelineId shadow, shadow_two_sided, sphere_shadow;
  PipelineId contact, sphere_contact, blur_x, blur_y;
  PipelineId enlarge;
  PipelineId ground_depth;
  /// [0] drawn behind the other surfaces by depth test, [1] blended under them by transmittance.
  std::array<PipelineId, 2> ground, ground_bare, sky;
  PipelineId line, line_hidden, line_over;
  PipelineId point, point_hidden, point_over;
  PipelineId ui;
  PipelineId place;  ///< draws a finished picture as a part of another one
  /// For liquids and smoke; they also have the uniform block Soft, and after shadow_map the
  /// textures that SoftPass binds.
  PipelineId veil_shade, veil_layer, fluid_depth, narrow_range_x, narrow_range_y, fluid_thickness,
      fluid_surface, smoke, smoke_cover;

  using Make = std::function<Result<PipelineId>(const PipelineDesc&)>;
  /// Reads all shaders and makes a pipeline of each description, until one fails.
  Status make_all(const Make& make, const std::filesystem::path& folder);
  /// On a device, which compiles shaders when they are first drawn with; on failure the pipelines
  /// already made are destroyed.
  static Result<Pipelines> create(Device& device, const std::filesystem::path& folder);
  void destroy(Device& device);
};

}  // namespace tumble
