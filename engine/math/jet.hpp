#pragma once
#include "engine/math/triple.hpp"

#include <cmath>
#include <type_traits>

namespace tumble {

/// Value, first and second derivative of a function of one variable at one point, with arithmetic
/// by the product and chain rules (Griewank & Walther, Evaluating Derivatives, 2008, 13.2).
struct Jet {
  double v = 0, d = 0, dd = 0;

  Jet() = default;
  Jet(double value) : v(value) {}
  Jet(double value, double first, double second) : v(value), d(first), dd(second) {}

  Jet operator-() const { return {-v, -d, -dd}; }
  Jet operator+(const Jet& o) const { return {v + o.v, d + o.d, dd + o.dd}; }
  Jet operator-(const Jet& o) const { return {v - o.v, d - o.d, dd - o.dd}; }
  Jet operator*(const Jet& o) const {
    return {v * o.v, d * o.v + v * o.d, dd * o.v + 2 * d * o.d + v * o.dd};
  }
  Jet operator/(const Jet& o) const {
    const double q = v / o.v, dq = (d - q * o.d) / o.v;
    return {q, dq, (dd - 2 * dq * o.d - q * o.dd) / o.v};
  }
};

/// The argument's value must be positive.
inline Jet sqrt(const Jet& x) {
  const double r = std::sqrt(x.v), dr = 0.5 * x.d / r;
  return {r, dr, (0.5 * x.dd - dr * dr) / r};
}

/// A point or direction as a function of one variable.
using Jet3 = Triple<Jet>;

inline Vec3 value(const Plain3& p) {
  return p.vec();
}
inline Vec3 value(const Jet3& p) {
  return {p.x.v, p.y.v, p.z.v};
}
inline double value(double x) {
  return x;
}
inline double value(const Jet& x) {
  return x.v;
}
inline Vec3 first(const Jet3& p) {
  return {p.x.d, p.y.d, p.z.d};
}
/// Made of a value and its derivatives; a plain triple takes the value only.
template <class Number>
Triple<Number> triple_of(const Vec3& v, const Vec3& d, const Vec3& dd) {
  if constexpr (std::is_same_v<Number, Jet>)
    return {{v.x(), d.x(), dd.x()}, {v.y(), d.y(), dd.y()}, {v.z(), d.z(), dd.z()}};
  else
    return Triple<Number>::of(v);
}

}  // namespace tumble
