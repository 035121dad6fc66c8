#pragma once
#include "viewer/render/draw_plan.hpp"
#include "viewer/render/light_fit.hpp"

namespace tumble {

/// The values of a quality preset.
struct QualityValues {
  int samples, shadow_size, contact_size;
  bool operator==(const QualityValues&) const = default;
};
QualityValues values_of(Quality quality);

/// Everything that follows from camera, sun and bounds of a picture.
struct FrameSetup {
  Camera camera;  ///< with near and far filled in
  ViewSetup view;
  GpuFrame uniforms;
  bool shadows = false;
  double shadow_texel = 0, contact_texel = 0;  ///< size of a texel of the maps, on surfaces
                                               ///< perpendicular to the sun or on the ground [m]
  Aabb region;        ///< things beyond it would be smaller than a dot, or lost in haze
  double lowest = 0;  ///< nothing that is drawn is below this height [m]
};
FrameSetup make_frame_setup(const RenderScene& scene, int width, int height);

}  // namespace tumble
