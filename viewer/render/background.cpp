#include "viewer/render/background.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

bool rim_is_hidden(const RenderScene& scene, const FrameSetup& setup) {
  const double haze = double(setup.uniforms.ground[3]) * setup.camera.far;
  return !scene.ground.visible || haze * haze > 255;
}

int rows_with_sky(const RenderScene& scene, const FrameSetup& setup) {
  const GpuFrame& u = setup.uniforms;
  const auto vec = [](const std::array<float, 4>& v) {
    return Vec3(double(v[0]), double(v[1]), double(v[2]));
  };
  // Rays go forward + x right + y up, x and y in -1..1, and meet the ground at a depth of -height
  // over their own y. It is drawn as far as the picture reaches, and 1.1 times as far to all sides.
  const Vec3 right = vec(u.view_right), up = vec(u.view_up), forward = vec(u.view_forward);
  const double height = setup.view.eye.y() - double(scene.ground.height);
  const double longest = forward.norm() + right.norm() + up.norm();
  const double deepest = setup.camera.far * std::min(1.0, 1.1 / longest);
  if (!scene.ground.visible || height <= 0 || up.y() <= 1e-6) return setup.view.height;
  const double lowest = (-height / deepest - forward.y() - std::abs(right.y())) / up.y();
  const double from_top = 0.5 * (1 - lowest) * setup.view.height;
  return std::clamp(int(std::floor(std::clamp(from_top, -4.0, 2.0 * setup.view.height))) + 2, 0,
                    setup.view.height);
}

}  // namespace tumble
