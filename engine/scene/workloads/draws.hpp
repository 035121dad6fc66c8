#pragma once
#include "engine/math/det/det.hpp"
#include "engine/math/types.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tumble {

/// The random numbers of the workloads' definitions: the linear congruential generator of Knuth's
/// MMIX (TAOCP vol. 2, 3.3.4, table 1), of which the upper 31 bits are used.
class WorkloadDraws {
 public:
  explicit WorkloadDraws(uint64_t seed) : state_(seed) {}

  /// In [0, 1).
  double unit() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return double(state_ >> 33) / 2147483648.0;
  }
  /// In [a, b).
  double between(double a, double b) { return a + (b - a) * unit(); }
  /// Uniform on the sphere.
  Vec3 direction() {
    const double z = 2 * unit() - 1, turn = 2 * det::pi * unit();
    const double r = std::sqrt(std::max(0.0, 1 - z * z));
    return {r * det::cos(turn), r * det::sin(turn), z};
  }
  /// Uniform over all rotations (Shoemake, "Uniform random rotations", Graphics Gems III, 1992).
  Quat orientation() {
    const double a = unit(), b = 2 * det::pi * unit(), c = 2 * det::pi * unit();
    const double r1 = std::sqrt(1 - a), r2 = std::sqrt(a);
    return {r1 * det::sin(b), r1 * det::cos(b), r2 * det::sin(c), r2 * det::cos(c)};
  }

 private:
  uint64_t state_;
};

}  // namespace tumble
