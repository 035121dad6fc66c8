#pragma once
#include "viewer/render/draw_plan.hpp"
#include "viewer/render/light_fit.hpp"

namespace tumble {

/// What a quality preset stands for.
struct QualityValues {
  int samples, shadow_size, contact_size;
  bool operator==(const QualityValues&) const = default;
};
QualityValues values_of(Quality quality);

/// Everything about a picture that follows from camera, sun and bounds.
struct FrameSetup {
  Camera camera;  ///< with near and far filled in
  ViewSetup view;
  GpuFrame uniforms;
  bool shadows = false;
  double shadow_texel = 0, contact_texel = 0;  ///< of the maps, on what faces sun or ground [m]
  Aabb region;                                 ///< what is beyond it is a dot in the haze
  double lowest = 0;                           ///< nothing that is drawn is below this height [m]
};
FrameSetup make_frame_setup(const RenderScene& scene, int width, int height);

}  // namespace tumble
