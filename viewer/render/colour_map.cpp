#include "viewer/render/colour_map.hpp"

#include "engine/math/det/det.hpp"
#include "viewer/render/render_scene.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

// S. van der Walt and N. Smith's viridis (matplotlib 2.0, 2015) as polynomials of the sixth degree
// (M. Zucker, "matplotlib colormaps", shadertoy.com/view/WlfXRN, CC0), within 0.02 of the table.
Vec3f viridis_srgb(double u) {
  static const Vec3 c[] = {
      {0.2777273272234177, 0.005407344544966578, 0.3340998053353061},
      {0.1050930431085774, 1.404613529898575, 1.384590162594685},
      {-0.3308618287255563, 0.214847559468213, 0.09509516302823659},
      {-4.634230498983486, -5.799100973351585, -19.33244095627987},
      {6.228269936347081, 14.17993336680509, 56.69055260068105},
      {4.776384997670288, -13.74514537774601, -65.35303263337234},
      {-5.435455855934631, 4.645852612178535, 26.3124352495832},
  };
  const double t = std::clamp(u, 0.0, 1.0);
  Vec3 sum = Vec3::Zero();
  for (int k = 6; k >= 0; --k) sum = t * sum + c[k];
  return sum.cwiseMax(0).cwiseMin(1).cast<float>();
}

const std::array<Vec3f, 256>& viridis_table() {
  static const auto table = [] {
    std::array<Vec3f, 256> out;
    for (size_t i = 0; i < out.size(); ++i) {
      const Vec3f c = viridis_srgb(double(i) / 255);
      uint32_t rgb = 0;
      for (int k = 0; k < 3; ++k) rgb = rgb << 8 | uint32_t(c[k] * 255 + 0.5f);
      out[i] = linear_from_srgb(rgb);
    }
    return out;
  }();
  return table;
}

Vec3f viridis_linear(double value, double low, double high) {
  if (!std::isfinite(value)) return Vec3f::Constant(0.2f);
  const double u = high > low ? std::clamp((value - low) / (high - low), 0.0, 1.0) : 0.5;
  return viridis_table()[size_t(u * 255 + 0.5)];
}

std::vector<double> NiceScale::numbers() const {
  std::vector<double> out;
  const double slack = 1e-6;  // in steps: a multiple that rounding puts just outside still counts
  for (double n = std::ceil(low / step - slack); n * step <= high + slack * step; ++n)
    out.push_back(n == 0 ? 0 : n * step);
  return out;
}

NiceScale nice_scale(double low, double high, bool rounded) {
  NiceScale out{low, high, 1};
  if (!(high > low)) {
    const double half = low == 0 ? 1 : 0.1 * std::abs(low);
    out.low = low == 0 ? 0 : low - half;
    out.high = low + half;
  }
  const double span = out.high - out.low;
  const double power = std::floor(det::log(span / 5) / det::log(10.0));
  const double base = det::pow(10.0, power);
  for (const double factor : {1.0, 2.0, 5.0, 10.0}) {
    out.step = factor * base;
    if (span <= 5.000001 * out.step) break;
  }
  if (rounded) {
    out.low = out.step * std::floor(out.low / out.step + 1e-6);
    out.high = out.step * std::ceil(out.high / out.step - 1e-6);
  }
  return out;
}

}  // namespace tumble
