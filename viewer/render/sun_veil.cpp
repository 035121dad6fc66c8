#include "viewer/render/sun_veil.hpp"

#include "engine/math/det/det.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

/// Share of a puff's opacity that takes light away from what is behind it. The rest is scattered,
/// mostly forwards, and gets through [-].
constexpr float smoke_shade = 0.45f;
/// Loss of light at the surface of a liquid by reflection and refraction, besides absorption [-].
constexpr float surface_loss = 0.25f;
constexpr float no_depth = 1;

class VeilMaker {
 public:
  VeilMaker(const RenderScene& scene, const Vec3& to_sun, const Aabb& region, int size,
            SunVeil& veil)
      : scene_(scene), region_(region), size_(size), veil_(veil) {
    axis_[2] = -to_sun;
    tangent_frame(to_sun, axis_[0], axis_[1]);
  }

  void run() {
    veil_.size = 0;
    veil_.smoke_light.assign(scene_.smoke.size(), 1);
    if (!fit()) return;
    const size_t cells = size_t(size_) * size_t(size_);
    left_.assign(cells, Vec3f::Ones());
    front_.assign(cells, no_depth);
    for (const FluidSurface& fluid : scene_.fluids) add_fluid(fluid);
    add_smoke();
    veil_.cells.resize(cells);
    for (size_t i = 0; i < cells; ++i) veil_.cells[i] = packed(left_[i], front_[i]);
    veil_.size = size_;
  }

 private:
  Vec3 in_light(const Vec3f& x) const {
    const Vec3 d = x.cast<double>();
    return {axis_[0].dot(d), axis_[1].dot(d), axis_[2].dot(d)};
  }
  bool within(const Vec3f& centre) const { return region_.contains(centre.cast<double>()); }

  /// Fits the raster around everything, with an empty rim.
  bool fit() {
    Aabb box;
    double widest = 0;
    const auto include = [&](const auto& ball) {
      if (!drawable(ball) || !within(ball.centre)) return;
      const Vec3 x = in_light(ball.centre);
      const Vec3 r = Vec3::Constant(double(ball.radius));
      box.include(Vec3(x - r));
      box.include(Vec3(x + r));
      widest = std::max(widest, double(ball.radius));
    };
    for (const FluidSurface& fluid : scene_.fluids)
      for (const FluidParticle& p : fluid.particles) include(p);
    for (const SmokePuff& p : scene_.smoke) include(p);
    if (box.empty() || !box.min.allFinite() || !box.max.allFinite()) return false;
    const double side = std::max(box.extent().x(), box.extent().y()) * size_ / (size_ - 4.0);
    low_ = box.centre() - 0.5 * Vec3(side, side, box.extent().z());
    cells_per_metre_ = size_ / side;
    veil_.depth = std::max(box.extent().z(), 1e-6);
    const Vec3 scale(1 / side, 1 / side, 1 / veil_.depth);
    const Mat3 axes =
        Mat3::from_rows(scale[0] * axis_[0], scale[1] * axis_[1], scale[2] * axis_[2]);
    veil_.veil_from_world = Mat4::affine(axes, -scale.cwiseProduct(low_));
    return true;
  }

  /// Calls f(cell, share of the radius to the centre, squared) for the cells of a disc, at least
  /// one.
  template <class F>
  void over_disc(const Vec3& x, double radius, const F& f) const {
    const double u = (x.x() - low_.x()) * cells_per_metre_,
                 v = (x.y() - low_.y()) * cells_per_metre_;
    const double r = std::max(radius * cells_per_metre_, 0.75);
    const auto cell = [this](double a) { return std::clamp(int(std::floor(a)), 0, size_ - 1); };
    const double by_r2 = 1 / (r * r);
    const int i0 = cell(u - r), i1 = cell(u + r), j1 = cell(v + r);
    for (int j = cell(v - r); j <= j1; ++j)
      for (int i = i0; i <= i1; ++i) {
        const double du = i + 0.5 - u, dv = j + 0.5 - v, d2 = (du * du + dv * dv) * by_r2;
        if (d2 < 1) f(size_t(j) * size_t(size_) + size_t(i), d2);
      }
  }

  float depth_of(const Vec3& x, double before) const {
    return float(std::clamp((x.z() - before - low_.z()) / veil_.depth, 0.0, 1.0));
  }

  void add_fluid(const FluidSurface& fluid) {
    thickness_.assign(left_.size(), 0);
    for (const FluidParticle& p : fluid.particles) {
      if (!drawable(p) || !within(p.centre)) continue;
      const Vec3 x = in_light(p.centre);
      const double r = double(p.radius);
      over_disc(x, r, [&](size_t cell, double d2) {
        const double half = r * std::sqrt(1 - d2);
        thickness_[cell] += float(2 * half) * fluid.fill;
        front_[cell] = std::min(front_[cell], depth_of(x, half));
      });
    }
    const Vec3f sigma = absorption(fluid);
    for (size_t i = 0; i < left_.size(); ++i) {
      const float t = thickness_[i];
      if (!(t > 0)) continue;
      const float some = std::min(t / (2 * fluid.radius), 1.0f);
      for (int k = 0; k < 3; ++k)
        left_[i][k] *= float(det::exp(-double(sigma[k] * t))) * (1 - surface_loss * some);
    }
  }

  void add_smoke() {
    std::vector<std::pair<double, uint32_t>> order;
    for (uint32_t i = 0; i < scene_.smoke.size(); ++i)
      if (drawable(scene_.smoke[i]) && within(scene_.smoke[i].centre))
        order.emplace_back(axis_[2].dot(scene_.smoke[i].centre.cast<double>()), i);
    std::sort(order.begin(), order.end());
    for (const auto& [depth, i] : order) {
      const SmokePuff& p = scene_.smoke[i];
      const Vec3 x = in_light(p.centre);
      float light = 0, weight = 0;
      over_disc(x, 0.5 * double(p.radius), [&](size_t cell, double d2) {
        const auto w = float(1 - d2);
        light += w * left_[cell].sum() / 3;
        weight += w;
      });
      if (weight > 0) veil_.smoke_light[i] = light / weight;
      over_disc(x, double(p.radius), [&](size_t cell, double d2) {
        left_[cell] *= 1 - smoke_shade * p.opacity * float((1 - d2) * (1 - d2));
        front_[cell] = std::min(front_[cell], depth_of(x, 0.5 * double(p.radius)));
      });
    }
  }

  static uint32_t packed(const Vec3f& colour, float depth) {
    const auto byte = [](float x) { return uint32_t(std::clamp(x, 0.f, 1.f) * 255 + 0.5f); };
    return byte(colour.x()) | byte(colour.y()) << 8 | byte(colour.z()) << 16 | byte(depth) << 24;
  }

  const RenderScene& scene_;
  const Aabb& region_;
  int size_;
  SunVeil& veil_;
  Vec3 axis_[3];  ///< axes of the raster, and the direction away from the sun
  Vec3 low_ = Vec3::Zero();
  double cells_per_metre_ = 1;
  std::vector<Vec3f> left_;
  std::vector<float> front_, thickness_;
};

}  // namespace

Vec3f absorption(const FluidSurface& fluid) {
  Vec3f sigma;
  for (int k = 0; k < 3; ++k)
    sigma[k] = float(-det::log(std::clamp(double(fluid.colour[k]), 0.002, 1.0))) /
               std::max(fluid.clarity, 1e-6f);
  return sigma;
}

void make_sun_veil(const RenderScene& scene, const Vec3& to_sun, const Aabb& region, int size,
                   SunVeil& veil) {
  VeilMaker(scene, to_sun, region, size, veil).run();
}

}  // namespace tumble
