#include "viewer/render/foam.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tumble {
namespace {

/// Only near the surface is there air to take in: particles denser than this are inside [-].
constexpr float inner_share = 0.97f;
/// Speeds of approach at which liquid begins to break and is all white, in units of the speed of
/// waves as long as ten spacings.
constexpr double first_break = 0.15, all_broken = 0.6;
/// Shares of the density at rest at which a drop is as white as can be, and not white [-].
constexpr double white_drop = 0.35, clear_drop = 0.6;
constexpr double gravity = 9.81;  ///< that of waves on Earth [m/s2]

/// A particle of the liquid and what is known of all.
class FoamFinder {
 public:
  FoamFinder(const LiquidNeighbours& neighbours, std::span<const Vec3f> v,
             std::span<const float> share)
      : neighbours_(neighbours), v_(v), share_(share) {}

  /// Calls f(place, particle) for what is near the surface.
  template <class F>
  void over_surface(const F& f) const {
    for (size_t place = 0; place < neighbours_.size(); ++place) {
      const uint32_t i = neighbours_.particle(place);
      if (share_[i] <= inner_share) f(place, i);
    }
  }
  /// Mean speed at which neighbours come nearer [m/s]; what is nearer weighs more.
  double approach(size_t place) const {
    double sum = 0, weights = 0;
    const uint32_t i = neighbours_.particle(place);
    neighbours_.over(place, [&](uint32_t j, double u) {
      const Vec3 v = (v_[i] - v_[j]).cast<double>();
      const Vec3 apart = (neighbours_.x()[i] - neighbours_.x()[j]).normalized();
      weights += 1 - u;
      // |v| (1 - cos) / 2: nothing of what moves apart, all of what meets.
      sum += (1 - u) * 0.5 * (v.norm() - v.dot(apart));
    });
    return weights > 0 ? sum / weights : 0;
  }
  double mean_about(size_t place, const std::vector<float>& value) const {
    double sum = double(value[neighbours_.particle(place)]), weights = 1;
    neighbours_.over(place, [&](uint32_t j, double u) {
      sum += (1 - u) * double(value[j]);
      weights += 1 - u;
    });
    return sum / weights;
  }

 private:
  const LiquidNeighbours& neighbours_;
  std::span<const Vec3f> v_;
  std::span<const float> share_;
};

}  // namespace

std::vector<float> foam_of(const LiquidNeighbours& neighbours, std::span<const Vec3f> v,
                           std::span<const float> share) {
  const size_t n = neighbours.size();
  std::vector<float> foam(n, 0);
  if (!neighbours.known() || v.size() != n || share.size() != n) return foam;
  const FoamFinder finder(neighbours, v, share);
  const double wave = std::sqrt(gravity * 10 * neighbours.spacing() / (2 * std::numbers::pi));
  std::vector<float> broken(n, 0);
  finder.over_surface([&](size_t place, uint32_t i) {
    const double speed = finder.approach(place) / wave;
    broken[i] = float(std::clamp((speed - first_break) / (all_broken - first_break), 0.0, 1.0));
  });
  finder.over_surface([&](size_t place, uint32_t i) {
    const double alone = (clear_drop - double(share[i])) / (clear_drop - white_drop);
    foam[i] = float(std::clamp(std::max(finder.mean_about(place, broken), alone), 0.0, 1.0));
  });
  return foam;
}

}  // namespace tumble
