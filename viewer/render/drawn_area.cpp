#include "viewer/render/drawn_area.hpp"

#include <algorithm>
#include <limits>

namespace tumble {
namespace {

/// What antialiasing, and the outline of what is selected, add to a body [px].
constexpr double rim = 2, outline_rim = 6;

class AreaFinder {
 public:
  explicit AreaFinder(const ViewSetup& view)
      : view_(view), frustum_(frustum_of(view.clip_from_world)) {}

  /// The parallelepiped of these half axes around a centre.
  void add(const Vec3& centre, const std::array<Vec3, 3>& half, double around) {
    if (!frustum_.sees_sphere(centre, half[0].norm() + half[1].norm() + half[2].norm())) return;
    const Vec4 at = clip(centre, 1);
    std::array<Vec4, 3> h;
    for (size_t k = 0; k < 3; ++k) h[k] = clip(half[k], 0);
    double low[2] = {infinity, infinity}, high[2] = {-infinity, -infinity};
    for (int corner = 0; corner < 8; ++corner) {
      Vec4 c = at;
      for (size_t k = 0; k < 3; ++k) c = corner >> k & 1 ? Vec4(c + h[k]) : Vec4(c - h[k]);
      if (!(c.w() > 1e-6 * at.w())) return all();  // beside or behind the eye
      for (int k = 0; k < 2; ++k) {
        low[k] = std::min(low[k], c[k] / c.w());
        high[k] = std::max(high[k], c[k] / c.w());
      }
    }
    const double size[2] = {double(view_.width), double(view_.height)};
    for (int k = 0; k < 2; ++k) {
      low[k] = std::max(0.5 * (low[k] + 1) * size[k] - around, 0.0);
      high[k] = std::min(0.5 * (high[k] + 1) * size[k] + around, size[k]);
    }
    if (!(low[0] < high[0] && low[1] < high[1])) return;
    for (size_t k = 0; k < 2; ++k) {
      low_[k] = std::min(low_[k], low[k]);
      high_[k] = std::max(high_[k], high[k]);
    }
  }
  void all() {
    low_ = {0, 0};
    high_ = {double(view_.width), double(view_.height)};
  }
  std::optional<ScissorRect> area() const {
    if (!(low_[0] < high_[0] && low_[1] < high_[1])) return {};
    const int left = int(low_[0]), right = std::min(int(high_[0]) + 1, view_.width);
    const int below = int(low_[1]), top = std::min(int(high_[1]) + 1, view_.height);
    return ScissorRect{left, view_.height - top, right - left, top - below};
  }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  Vec4 clip(const Vec3& x, double w) const {
    return view_.clip_from_world * Vec4(x.x(), x.y(), x.z(), w);
  }
  const ViewSetup& view_;
  Frustum frustum_;
  std::array<double, 2> low_{infinity, infinity}, high_{-infinity, -infinity};  ///< [px], y upwards
};

}  // namespace

std::optional<ScissorRect> drawn_area(const RenderScene& scene, const ViewSetup& view) {
  AreaFinder finder(view);
  for (const MeshInstance& i : scene.instances) {
    if (!i.mesh || !i.transform.offset.allFinite() || !i.transform.linear.allFinite()) continue;
    const Mat3f& l = i.transform.linear;
    const MeshData& m = *i.mesh;
    const Vec3 centre = (l * (0.5f * (m.min + m.max)) + i.transform.offset).cast<double>();
    std::array<Vec3, 3> half;
    for (int k = 0; k < 3; ++k) {
      // Inflation moves corners out by at most this along each axis.
      const double length = double(l.col(k).norm());
      const double reach = 0.5 * double(m.max[k] - m.min[k]) * length + double(i.inflate);
      half[size_t(k)] =
          length > 0 ? Vec3(l.col(k).cast<double>() * (reach / length)) : Vec3(Vec3::Zero());
    }
    finder.add(centre, half,
               i.selected ? outline_rim * std::max(1.0, double(scene.ui_scale)) : rim);
  }
  for (const SphereInstance& s : scene.spheres) {
    const auto r = double(s.radius);
    finder.add(s.centre.cast<double>(), {Vec3::UnitX() * r, Vec3::UnitY() * r, Vec3::UnitZ() * r},
               rim);
  }
  return finder.area();
}

}  // namespace tumble
