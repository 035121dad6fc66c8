#pragma once
#include "engine/math/double_double.hpp"

#include <cstddef>
#include <vector>

namespace tumble {

/// An exact real number: an unevaluated sum of doubles that do not overlap, smallest first, without
/// zeros (Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
/// Predicates", 1997). Slow; used where a floating-point filter could not decide.
///
/// Exact as long as nothing overflows or underflows. A product of k coordinates is safe when each
/// is zero or between 2^-b and 2^b in magnitude with k (b + 53) <= 1000: 1e-80 to 1e80 for
/// products of three, 1e-59 to 1e59 for four, 1e-34 to 1e34 for six.
class Expansion {
 public:
  Expansion() = default;
  explicit Expansion(double x) {
    if (x != 0) terms_.push_back(x);
  }
  static Expansion sum(double a, double b);
  static Expansion difference(double a, double b) { return sum(a, -b); }
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
  void compress();
  std::vector<double> terms_;
};

inline Expansion abs(const Expansion& x) {
  return x.sign() < 0 ? -x : x;
}
inline Expansion max(const Expansion& a, const Expansion& b) {
  return (a - b).sign() < 0 ? b : a;
}
inline Expansion min(const Expansion& a, const Expansion& b) {
  return (a - b).sign() > 0 ? b : a;
}

}  // namespace tumble
