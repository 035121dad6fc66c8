#pragma once
#include "engine/math/types.hpp"

#include <cmath>

namespace tumble {

/// A function of one variable at one point: value, first and second derivative. Arithmetic follows
/// the rules of Leibniz and of the chain (Griewank & Walther, Evaluating Derivatives, 2008, 13.2).
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

/// Three of them.
struct Jet3 {
  Jet x, y, z;

  static Jet3 constant(const Vec3& p) { return {p.x(), p.y(), p.z()}; }
  static Jet3 of(const Vec3& v, const Vec3& d, const Vec3& dd) {
    return {{v.x(), d.x(), dd.x()}, {v.y(), d.y(), dd.y()}, {v.z(), d.z(), dd.z()}};
  }
  Vec3 value() const { return {x.v, y.v, z.v}; }
  Vec3 first() const { return {x.d, y.d, z.d}; }
  Vec3 second() const { return {x.dd, y.dd, z.dd}; }

  Jet3 operator-() const { return {-x, -y, -z}; }
  Jet3 operator+(const Jet3& o) const { return {x + o.x, y + o.y, z + o.z}; }
  Jet3 operator-(const Jet3& o) const { return {x - o.x, y - o.y, z - o.z}; }
  Jet3 operator*(const Jet& f) const { return {x * f, y * f, z * f}; }
  Jet3 operator/(const Jet& f) const { return {x / f, y / f, z / f}; }
  Jet dot(const Jet3& o) const { return x * o.x + y * o.y + z * o.z; }
  Jet3 cross(const Jet3& o) const {
    return {y * o.z - z * o.y, z * o.x - x * o.z, x * o.y - y * o.x};
  }
  Jet norm() const { return sqrt(dot(*this)); }
};

}  // namespace tumble
