#include "viewer/render/foam.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tumble {
namespace {

/// Particles with more than this share of the rest density are inside, where there is no air to
/// entrain [-].
constexpr float inner_share = 0.97f;
/// Approach speeds at which the liquid begins to whiten and is fully white, in units of the speed
/// of gravity waves with a wavelength of ten spacings [-].
constexpr double first_break = 0.15, all_broken = 0.6;
/// Shares of the rest density at which an isolated drop is fully white, and not white at all [-].
constexpr double white_drop = 0.35, clear_drop = 0.6;
constexpr double gravity = 9.81;  ///< for the speed of waves [m/s2]

/// The liquid's particles, their velocities and densities.
class FoamFinder {
 public:
  FoamFinder(const LiquidNeighbours& neighbours, std::span<const Vec3f> v,
             std::span<const float> share)
      : neighbours_(neighbours), v_(v), share_(share) {}

  /// Calls f(rank, particle) for particles near the surface.
  template <class F>
  void over_surface(const F& f) const {
    for (size_t place = 0; place < neighbours_.size(); ++place) {
      const uint32_t i = neighbours_.particle(place);
      if (share_[i] <= inner_share) f(place, i);
    }
  }
  /// Mean approach speed of the neighbours [m/s], with larger weights for nearer ones.
  double approach(size_t place) const {
    double sum = 0, weights = 0;
    const uint32_t i = neighbours_.particle(place);
    neighbours_.over(place, [&](uint32_t j, double u) {
      const Vec3 v = (v_[i] - v_[j]).cast<double>();
      const Vec3 apart = (neighbours_.x()[i] - neighbours_.x()[j]).normalized();
      weights += 1 - u;
      // v| (1 - cos) / 2: zero for separating, |v| for head-on approach.
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
