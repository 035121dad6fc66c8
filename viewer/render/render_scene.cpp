#include "viewer/render/render_scene.hpp"

#include "engine/math/det/det.hpp"

namespace tumble {

Vec3f linear_from_srgb(uint32_t rgb) {
  Vec3f out;
  for (int i = 0; i < 3; ++i) {
    const double c = double((rgb >> (16 - 8 * i)) & 255u) / 255;
    out[i] = float(c <= 0.04045 ? c / 12.92 : det::pow((c + 0.055) / 1.055, 2.4));
  }
  return out;
}

Transform transform_of(const Pose& pose, const Vec3& scale) {
  const Mat3 m = pose.q.toRotationMatrix() * scale.asDiagonal();
  return {m.cast<float>(), pose.x.cast<float>()};
}

void RenderScene::clear_content() {
  instances.clear();
  spheres.clear();
  lines.clear();
  points.clear();
  texts.clear();
  ui.vertices.clear();
  ui.indices.clear();
  ui.draws.clear();
}

Aabb content_bounds(const RenderScene& scene) {
  Aabb box;
  for (const MeshInstance& i : scene.instances) {
    if (!i.mesh) continue;
    const Eigen::Matrix3f& m = i.transform.linear;
    const Vec3f centre = m * (0.5f * (i.mesh->min + i.mesh->max)) + i.transform.offset;
    const Vec3f half =
        m.cwiseAbs() * (0.5f * (i.mesh->max - i.mesh->min)) + Vec3f::Constant(i.inflate);
    box.include((centre - half).cast<double>());
    box.include((centre + half).cast<double>());
  }
  for (const SphereInstance& s : scene.spheres) {
    box.include((s.centre.array() - s.radius).cast<double>());
    box.include((s.centre.array() + s.radius).cast<double>());
  }
  return box;
}

}  // namespace tumble
