#pragma once
#include <cstdint>

namespace tumble {

/// PCG-XSH-RR 64/32 (O'Neill 2014). Draws are converted by hand, because the distributions of the
/// standard library differ between implementations.
class Random {
 public:
  explicit Random(uint64_t seed = 1, uint64_t stream = 0) : increment_((stream << 1) | 1) {
    next();
    state_ += seed;
    next();
  }

  /// Uniform over all 32-bit values.
  uint32_t next() {
    const uint64_t old = state_;
    state_ = old * 6364136223846793005ULL + increment_;
    const auto shifted = uint32_t(((old >> 18) ^ old) >> 27);
    const auto rotation = uint32_t(old >> 59);
    return (shifted >> rotation) | (shifted << ((32 - rotation) & 31));
  }
  /// Uniform in [0, 1), 53 bits.
  double uniform() {
    const uint64_t high = next() >> 5, low = next() >> 6;
    return double((high << 26) | low) * (1.0 / 9007199254740992.0);
  }
  /// Uniform in [a, b).
  double uniform(double a, double b) { return a + (b - a) * uniform(); }
  /// Uniform in 0 .. n-1; n > 0.
  uint32_t below(uint32_t n) { return uint32_t((uint64_t{next()} * n) >> 32); }

 private:
  uint64_t state_ = 0;
  uint64_t increment_;
};

}  // namespace tumble
