#include "viewer/render/drawn_area.hpp"

#include "viewer/render/builtin_meshes.hpp"
#include "viewer/render/cell_raster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

/// What antialiasing, and the outline of what is selected, add to a body [px].
constexpr double rim = 2, outline_rim = 6;
/// Bodies that reach less than this below the ground are considered to rest on it (rounding) [px].
constexpr double unseen_depth = 1e-3;

/// The parallelepiped around a body: its half axes, and how much wider it is drawn.
struct BodyBox {
  Vec3 centre;
  std::array<Vec3, 3> half;
  bool round = false;  ///< an ellipsoid of these semi-axes
  double around = 0;   ///< [px]

  double lowest() const {
    const Vec3 h(half[0].y(), half[1].y(), half[2].y());
    return centre.y() - (round ? h.norm() : h.cwiseAbs().sum());
  }
};

class PartsFinder {
 public:
  explicit PartsFinder(const ViewSetup& view)
      : view_(view), frustum_(frustum_of(view.clip_from_world)), raster_(view.width, view.height) {}

  void add(const BodyBox& box) {
    const double reach = box.half[0].norm() + box.half[1].norm() + box.half[2].norm();
    if (!frustum_.sees_sphere(box.centre, reach)) return;
    const Vec4 at = clip(box.centre, 1);
    std::array<Vec4, 3> h;
    for (size_t k = 0; k < 3; ++k) h[k] = clip(box.half[k], 0);
    std::array<double, 2> low{infinity, infinity}, high{-infinity, -infinity};
    for (int corner = 0; corner < 8; ++corner) {
      Vec4 c = at;
      for (size_t k = 0; k < 3; ++k) c = corner >> k & 1 ? Vec4(c + h[k]) : Vec4(c - h[k]);
      if (!(c.w() > 1e-6 * at.w())) return raster_.mark_all();  // beside or behind the eye
      for (size_t k = 0; k < 2; ++k) {
        low[k] = std::min(low[k], c[int(k)] / c.w());
        high[k] = std::max(high[k], c[int(k)] / c.w());
      }
    }
    const double size[2] = {double(view_.width), double(view_.height)};
    for (size_t k = 0; k < 2; ++k) {
      low[k] = std::max(0.5 * (low[k] + 1) * size[k] - box.around, 0.0);
      high[k] = std::min(0.5 * (high[k] + 1) * size[k] + box.around, size[k]);
    }
    if (low[0] < high[0] && low[1] < high[1]) raster_.mark(low, high);
  }
  std::vector<ScissorRect> parts() const { return raster_.rectangles(); }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  Vec4 clip(const Vec3& x, double w) const {
    return view_.clip_from_world * Vec4(x.x(), x.y(), x.z(), w);
  }
  const ViewSetup& view_;
  Frustum frustum_;
  CellRaster raster_;
};

BodyBox box_of(const MeshInstance& i, float ui_scale) {
  const Mat3f& l = i.transform.linear;
  const MeshData& m = *i.mesh;
  BodyBox box;
  box.round = m.id == sphere_mesh()->id;
  box.centre = (l * (0.5f * (m.min + m.max)) + i.transform.offset).cast<double>();
  for (int k = 0; k < 3; ++k) {
    // Inflation moves corners out by at most this along each axis.
    const double length = double(l.col(k).norm());
    const double reach = 0.5 * double(m.max[k] - m.min[k]) * length + double(i.inflate);
    box.half[size_t(k)] =
        length > 0 ? Vec3(l.col(k).cast<double>() * (reach / length)) : Vec3(Vec3::Zero());
  }
  box.around = i.selected ? outline_rim * std::max(1.0, double(ui_scale)) : rim;
  return box;
}

BodyBox box_of(const SphereInstance& s) {
  const auto r = double(s.radius);
  return {s.centre.cast<double>(),
          {Vec3::UnitX() * r, Vec3::UnitY() * r, Vec3::UnitZ() * r},
          true,
          rim};
}

/// Calls f(box) for all that is drawn.
template <class F>
void for_each_box(const RenderScene& scene, const F& f) {
  for (const MeshInstance& i : scene.instances)
    if (i.mesh && i.transform.offset.allFinite() && i.transform.linear.allFinite())
      f(box_of(i, scene.ui_scale));
  for (const SphereInstance& s : scene.spheres) f(box_of(s));
}

}  // namespace

std::vector<ScissorRect> drawn_parts(const RenderScene& scene, const ViewSetup& view) {
  PartsFinder finder(view);
  for_each_box(scene, [&](const BodyBox& box) { finder.add(box); });
  return finder.parts();
}

std::vector<ScissorRect> sunken_parts(const RenderScene& scene, const ViewSetup& view) {
  PartsFinder finder(view);
  for_each_box(scene, [&](const BodyBox& box) {
    const double pixel =
        std::max((box.centre - view.eye).dot(view.forward), 0.0) / view.pixels_per_radian;
    const double outline = box.around > rim ? box.around : 0;
    if (double(scene.ground.height) - box.lowest() > (unseen_depth - outline) * pixel)
      finder.add(box);
  });
  return finder.parts();
}

}  // namespace tumble
