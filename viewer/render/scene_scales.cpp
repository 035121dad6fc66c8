#include "viewer/render/scene_scales.hpp"

#include "engine/collision/shape.hpp"

#include <algorithm>

namespace tumble {

SceneScales typical_scales(const Frame& frame) {
  std::vector<double> sizes, masses;
  for (size_t slot = 0; slot < frame.body_slots(); ++slot) {
    const BodyInfo& info = frame.info(slot);
    if (frame.body(slot).id.is_null() || info.type != BodyType::dynamic) continue;
    double size = 0;
    for (const BodyShape& part : info.shapes)
      size = std::max(size, part.pose.x.norm() + part.shape->bounding_radius());
    sizes.push_back(size);
    masses.push_back(info.mass);
  }
  if (sizes.empty()) return {};
  const auto median = [](std::vector<double>& v) {
    const auto middle = v.begin() + std::ptrdiff_t(v.size() / 2);
    std::nth_element(v.begin(), middle, v.end());
    return *middle;
  };
  const double g = frame.gravity.norm();
  return {median(sizes), median(masses) * (g > 0 ? g : 9.81)};
}

}  // namespace tumble
