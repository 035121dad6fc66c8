#pragma once
#include "viewer/render/device.hpp"

#include <array>
#include <filesystem>

namespace tumble {

/// For bodies: with closed surfaces, open ones, and balls that the shader finds.
struct BodyPipelines {
  PipelineId closed, two_sided, ball;
};

/// Every pipeline of the renderer. Bindings: textures shadow_map, contact_map (or image, source);
/// uniform blocks Frame (or Ui).
struct Pipelines {
  /// [0] cheap shading, [1] fine; of bodies then [0] plain, [1] with a pattern, as a shader of a
  /// software renderer works for what it leaves out.
  std::array<std::array<BodyPipelines, 2>, 2> bodies;
  std::array<PipelineId, 2> surface_blended;
  std::array<PipelineId, 2> sphere, sphere_blended;
  PipelineId outline;
  PipelineId shadow, shadow_two_sided, sphere_shadow;
  PipelineId contact, sphere_contact, blur_x, blur_y;
  PipelineId enlarge;
  PipelineId ground_depth;
  /// [0] behind what has been drawn, by depth; [1] under it, by its opacity.
  std::array<PipelineId, 2> ground, ground_bare, sky;
  PipelineId line, line_hidden, line_over;
  PipelineId point, point_hidden, point_over;
  PipelineId ui;
  PipelineId place;  ///< a finished picture as part of another
  /// Of liquids and smoke: also the block Soft, textures after shadow_map as SoftPass gives them.
  PipelineId veil_shade, veil_layer, fluid_depth, narrow_range_x, narrow_range_y, fluid_thickness,
      fluid_surface, smoke, smoke_cover;

  /// Compiles all; on failure those already made are destroyed.
  static Result<Pipelines> create(Device& device, const std::filesystem::path& folder);
  void destroy(Device& device);
};

}  // namespace tumble
