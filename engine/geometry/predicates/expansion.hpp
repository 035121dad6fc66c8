#pragma once
#include "engine/math/double_double.hpp"

#include <cstddef>
#include <vector>

namespace tumble {

/// An exact real number: an unevaluated sum of doubles that do not overlap, smallest first, without
/// zeros (Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
/// Predicates", 1997). Slow; used where a floating-point filter could not decide. Exact as long as
/// nothing overflows or underflows (magnitudes of 1e-70 to 1e70 in products of four are safe).
class Expansion {
 public:
  Expansion() = default;
  explicit Expansion(double x) {
    if (x != 0) terms_.push_back(x);
  }
  static Expansion difference(double a, double b);
  static Expansion product(double a, double b);

  Expansion operator+(const Expansion& other) const;
  Expansion operator-(const Expansion& other) const { return *this + -other; }
  Expansion operator*(const Expansion& other) const;
  Expansion operator*(double factor) const;
  Expansion operator-() const;

  /// -1, 0 or 1: the sign of the largest term.
  int sign() const { return terms_.empty() ? 0 : (terms_.back() > 0 ? 1 : -1); }
  /// Nearest double up to an ulp.
  double estimate() const;
  size_t size() const { return terms_.size(); }

 private:
  void grow(double x);
  std::vector<double> terms_;
};

}  // namespace tumble
