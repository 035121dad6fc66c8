#pragma once
#include "engine/geometry/predicates/expansion.hpp"
#include "engine/math/triple.hpp"

#include <array>
#include <cmath>
#include <cstdint>

/// Predicates written once as a polynomial and evaluated twice: in doubles with a running error
/// bound, and, where that cannot tell the sign, exactly.
namespace tumble {

/// A double and a bound of its distance from the exact value: every operation adds the error of
/// its operands and its own rounding, u = 2^-53 relative (Higham, "Accuracy and Stability of
/// Numerical Algorithms", 2002, §3.3 running error analysis). The factor 1 + 2^-50 covers the
/// rounding of the bound itself.
struct Estimate {
  double value = 0;
  double error = 0;

  static constexpr double u = 0x1p-53, widen = 1 + 0x1p-50;

  Estimate() = default;
  explicit Estimate(double x) : value(x) {}
  Estimate(double x, double e) : value(x), error(e) {}
  static Estimate sum(double a, double b) { return {a + b, u * std::fabs(a + b)}; }
  static Estimate difference(double a, double b) { return sum(a, -b); }
  static Estimate product(double a, double b) { return {a * b, u * std::fabs(a * b)}; }

  Estimate operator+(const Estimate& o) const {
    const double v = value + o.value;
    return {v, (error + o.error + u * std::fabs(v)) * widen};
  }
  Estimate operator-() const { return {-value, error}; }
  Estimate operator-(const Estimate& o) const { return *this + -o; }
  Estimate operator*(const Estimate& o) const {
    const double v = value * o.value;
    return {v, (std::fabs(value) * o.error + (std::fabs(o.value) + o.error) * error +
                u * std::fabs(v)) *
                   widen};
  }
  Estimate operator*(double f) const { return *this * Estimate(f); }
  /// Whether value has the sign of the exact number.
  bool sure() const { return std::fabs(value) > error || error == 0; }
  int sign() const { return (value > 0) - (value < 0); }
};

inline Estimate abs(const Estimate& x) {
  return {std::fabs(x.value), x.error};
}
inline Estimate max(const Estimate& a, const Estimate& b) {
  return {std::fmax(a.value, b.value), std::fmax(a.error, b.error)};
}
inline Estimate min(const Estimate& a, const Estimate& b) {
  return {std::fmin(a.value, b.value), std::fmin(a.error, b.error)};
}

/// How often the exact fallback ran in this thread, for benchmarks and tests.
inline uint64_t& exact_fallbacks() {
  static thread_local uint64_t count = 0;
  return count;
}

/// Exact sign of f(T()), a polynomial in T = Estimate or Expansion of its captured coordinates.
template <class Polynomial>
int exact_sign(const Polynomial& f) {
  const Estimate e = f(Estimate());
  if (e.sure()) return e.sign();
  ++exact_fallbacks();
  return f(Expansion()).sign();
}

template <class T>
Triple<T> exact_sum(const Vec3& a, const Vec3& b) {
  return {T::sum(a.x(), b.x()), T::sum(a.y(), b.y()), T::sum(a.z(), b.z())};
}
template <class T>
Triple<T> exact_difference(const Vec3& a, const Vec3& b) {
  return exact_sum<T>(a, -b);
}

}  // namespace tumble
