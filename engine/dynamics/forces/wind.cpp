#include "engine/dynamics/forces/wind.hpp"

#include "engine/core/random.hpp"
#include "engine/math/det/det.hpp"

namespace tumble {
namespace {

/// Frequencies of the sines relative to the first: no two have a ratio of small numbers.
constexpr std::array<double, 3> gust_ratio{1, 1.6180339887498949, 3.1415926535897931};
constexpr std::array<double, 3> gust_weight{0.5, 0.3, 0.2};

}  // namespace

WindDef::Flow WindDef::at(double t) const {
  const Vec3 mean = velocity.now();
  Flow flow{mean, Vec3::Zero(), gusts, t, {}, {}};
  const double speed2 = mean.squaredNorm();
  if (speed2 > 0) flow.slowness = mean / speed2;
  Random random(seed, 7);
  for (size_t i = 0; i < 3; ++i) {
    flow.frequency[i] = 2 * det::pi / gust_period * gust_ratio[i];
    flow.phase[i] = 2 * det::pi * random.uniform();
  }
  return flow;
}

Vec3 WindDef::Flow::operator()(const Vec3& x) const {
  if (gusts == 0) return velocity;
  const double local = t - slowness.dot(x);
  double s = 0;
  for (size_t i = 0; i < 3; ++i) s += gust_weight[i] * det::sin(frequency[i] * local + phase[i]);
  return (1 + gusts * s) * velocity;
}

}  // namespace tumble
