#pragma once
#include "engine/geometry/predicates/filtered.hpp"
#include "engine/math/double_double.hpp"

#include <algorithm>
#include <array>
#include <cmath>

/// Written once for Real = double and, where that is in doubt, DoubleDouble.
namespace tumble {

inline double leading(double x) {
  return x;
}
inline double leading(DoubleDouble x) {
  return x.high;
}
/// a - b: rounded once, or exactly.
template <class Real>
Real difference_of(double a, double b) {
  if constexpr (std::is_same_v<Real, double>) {
    return a - b;
  } else {
    Real d;
    two_sum(a, -b, d.high, d.low);
    return d;
  }
}
/// Relative error of any one operation, measured on the larger operand.
template <class Real>
constexpr double unit_of() {
  return std::is_same_v<Real, double> ? 0x1p-53 : 0x1p-101;
}

/// Three vectors that change linearly: two that span a plane and one from it to the other feature.
/// Vertex p and face a b c: u = b - a, v = c - a, x = p - a. Edges a b and c d: u = b - a,
/// v = d - c, x = c - a. Four points are coplanar when x . (u x v) = 0.
template <class Real>
struct MovingFrame {
  std::array<Triple<Real>, 2> u, v, x;  ///< at t = 0 and t = 1

  /// Whether all are in one coordinate plane throughout: then so are they in any arithmetic, and no
  /// cubic tells anything.
  bool flat() const {
    const auto zero = [&](auto coordinate) {
      for (const auto* w : {&u, &v, &x})
        for (const Triple<Real>& p : *w)
          if (leading(p.*coordinate) != 0) return false;
      return true;
    };
    return zero(&Triple<Real>::x) || zero(&Triple<Real>::y) || zero(&Triple<Real>::z);
  }
  static Triple<Real> way(const Vec3& to, const Vec3& from) {
    return {difference_of<Real>(to.x(), from.x()), difference_of<Real>(to.y(), from.y()),
            difference_of<Real>(to.z(), from.z())};
  }
};

/// f(t) = x . (u x v), a cubic, in Bernstein form with a bound on the rounding of coefficients and
/// values.
///
/// Rounding, in units of unit_of<Real>() times U V X (largest coordinates): u, v and x are known to
/// one unit relative, so that a coordinate of u x v, at most 2 U V, is off by 8, the middle one (a
/// mean) by 10; its product with x, at most 6 U V X, by 84; f1 and f2 by 102. Values: at() adds 48,
/// the polar form 54. The bound is 256.
template <class Real>
struct CoplanarityCubic {
  std::array<Real, 4> f;
  double error = 0;
  double u = 0, v = 0, x = 0;  ///< largest coordinate of each vector
  /// Whether products neither over- nor underflow, so that `error` holds; all three are non-zero.
  bool usable = false;

  explicit CoplanarityCubic(const MovingFrame<Real>& w) : u(most(w.u)), v(most(w.v)), x(most(w.x)) {
    const auto moderate = [](double size) { return size > 1e-60 && size < 1e60; };
    usable = moderate(u) && moderate(v) && moderate(x);
    const Triple<Real> n0 = w.u[0].cross(w.v[0]), n2 = w.u[1].cross(w.v[1]);
    const Triple<Real> n1 = (w.u[0].cross(w.v[1]) + w.u[1].cross(w.v[0])) * 0.5;
    f[0] = n0.dot(w.x[0]);
    f[1] = third(n1.dot(w.x[0]) * 2.0 + n0.dot(w.x[1]));
    f[2] = third(n2.dot(w.x[0]) + n1.dot(w.x[1]) * 2.0);
    f[3] = n2.dot(w.x[1]);
    error = 256 * unit_of<Real>() * (u * v * x);
  }

  Real at(Real t) const {
    const Real s = one_minus(t);
    return s * s * (s * f[0] + t * f[1] * 3.0) + t * t * (s * f[2] * 3.0 + t * f[3]);
  }
  /// The polar form with arguments a, b, c: coefficients on a part.
  Real polar(double a, double b, double c) const {
    const Real g0 = mix(f[0], f[1], a), g1 = mix(f[1], f[2], a), g2 = mix(f[2], f[3], a);
    return mix(mix(g0, g1, b), mix(g1, g2, b), c);
  }
  /// f'(t), for Newton's method.
  double slope(double t) const {
    const double s = 1 - t;
    return 3 * (s * (s * step(0) + 2 * t * step(1)) + t * t * step(2));
  }
  /// f[i + 1] - f[i].
  double step(size_t i) const { return leading(f[i + 1] - f[i]); }
  /// -1 or 1 when certain, else 0.
  int sign(Real value) const {
    return leading(value) > error ? 1 : leading(value) < -error ? -1 : 0;
  }
  static Real one_minus(Real t) {
    if constexpr (std::is_same_v<Real, double>) {
      return 1 - t;
    } else {
      return Real{1, 0} - t;
    }
  }

 private:
  static Real third(Real y) {
    if constexpr (std::is_same_v<Real, double>) {
      return y * (1.0 / 3);
    } else {
      return y * Real{1.0 / 3, 0x1.5555555555555p-56};
    }
  }
  static Real mix(Real a, Real b, double t) { return a + (b - a) * t; }
  static double most(const std::array<Triple<Real>, 2>& w) {
    double out = 0;
    for (const Triple<Real>& p : w) {
      out = std::max(
          {out, std::fabs(leading(p.x)), std::fabs(leading(p.y)), std::fabs(leading(p.z))});
    }
    return out * (1 + 0x1p-50);
  }
};

/// A part of [0, 1] where the cubic certainly has no root or exactly one, or that is in doubt.
struct CubicPiece {
  double begin = 0, end = 1;
  int sign_begin = 0, sign_end = 0;  ///< of f; 0 where in doubt

  bool in_doubt() const { return sign_begin == 0 || sign_end == 0; }
  bool has_root() const { return sign_begin * sign_end < 0; }
};

/// Fewer than two changes of sign among the coefficients, whatever those in doubt are.
inline bool at_most_one_change(int s0, int s1, int s2, int s3) {
  if (s0 == 0 || s3 == 0) return false;
  if (s0 == s3) return s1 == s0 && s2 == s0;
  return s1 == s0 || s2 == s3;
}

/// [0, 1] in at most three such pieces, split at the extrema of f, or its inflection: between them
/// the control polygon is monotone, so that the signs at the ends and Descartes' rule tell all.
struct CubicPieces {
  std::array<CubicPiece, 3> piece;
  int count = 0;

  template <class Real>
  explicit CubicPieces(const CoplanarityCubic<Real>& cubic) {
    const auto& f = cubic.f;
    const int first = cubic.sign(f[0]), last = cubic.sign(f[3]);
    if (at_most_one_change(first, cubic.sign(f[1]), cubic.sign(f[2]), last)) {
      count = 1;
      piece[0] = {0, 1, first, last};
      return;
    }
    // Extrema: d0 (1-t)^2 + 2 d1 (1-t) t + d2 t^2 = 0. They need not be exact.
    const double d0 = cubic.step(0), d1 = cubic.step(1), d2 = cubic.step(2);
    std::array<double, 4> cut{0, 1, 1, 1};
    size_t cuts = 1;
    const double discriminant = d1 * d1 - d0 * d2;
    if (discriminant >= 0) {
      const double q = -(d1 + std::copysign(std::sqrt(discriminant), d1));
      double r0 = q / (q + d2), r1 = d0 / (d0 + q);
      if (r1 < r0) std::swap(r0, r1);
      if (r0 > 0 && r0 < 1) cut[cuts++] = r0;
      if (r1 > cut[cuts - 1] && r1 < 1) cut[cuts++] = r1;
    } else {  // monotone: at its inflection, either side of which the polygon is monotone too
      const double r = (d0 - d1) / (d0 - 2 * d1 + d2);
      if (r > 0 && r < 1) cut[cuts++] = r;
    }
    cut[cuts] = 1;
    int sign_begin = first;
    for (size_t k = 0; k < cuts; ++k) {
      const double a = cut[k], b = cut[k + 1];
      const int sign_end = b < 1 ? cubic.sign(cubic.polar(b, b, b)) : last;
      const bool known = at_most_one_change(sign_begin, cubic.sign(cubic.polar(a, a, b)),
                                            cubic.sign(cubic.polar(a, b, b)), sign_end);
      piece[k] = {a, b, known ? sign_begin : 0, known ? sign_end : 0};
      sign_begin = sign_end;
    }
    count = int(cuts);
  }
};

/// The time t, known to `width` either way, at which a piece has its root: the signs at both sides
/// are certain. `width` is negative when it cannot be told within 1e-8.
template <class Real>
struct RootBracket {
  Real t{};
  double width = -1;
  bool found() const { return width >= 0; }
};

template <class Real>
RootBracket<Real> bracket_root(const CoplanarityCubic<Real>& cubic, const CubicPiece& piece) {
  double a = piece.begin, b = piece.end;
  const double fa = leading(cubic.polar(a, a, a)), fb = leading(cubic.polar(b, b, b));
  double t = a + (b - a) * (fa / (fa - fb));
  double width = 0;
  // Newton's method, halving where it leaves the part that holds the root.
  for (int k = 0; k < 60; ++k) {
    if (!(t > a && t < b)) t = 0.5 * (a + b);
    const double value = leading(cubic.at(Real{t})), slope = cubic.slope(t);
    (value > 0) == (piece.sign_begin > 0) ? a = t : b = t;
    const double step = value / slope;
    width = 2 * cubic.error / std::fabs(slope);
    if (std::fabs(value) <= cubic.error || std::fabs(step) < 0.25 * width ||
        std::fabs(step) < 0x1p-50) {
      break;
    }
    t -= step;
  }
  RootBracket<Real> root{Real{t}, -1};
  if constexpr (!std::is_same_v<Real, double>) {
    for (int k = 0; k < 3; ++k) {
      const double step = leading(cubic.at(root.t)) / cubic.slope(t);
      if (!(std::fabs(step) < 1e-6)) break;
      root.t = root.t - Real{step, 0};
    }
  }
  width += 8 * unit_of<Real>();
  for (int k = 0; k < 4 && width < 1e-8; ++k, width *= 8) {
    const Real lo = root.t - Real{width}, hi = root.t + Real{width};
    if ((leading(lo) <= piece.begin || cubic.sign(cubic.at(lo)) == piece.sign_begin) &&
        (leading(hi) >= piece.end || cubic.sign(cubic.at(hi)) == piece.sign_end)) {
      root.width = width;
      break;
    }
  }
  return root;
}

}  // namespace tumble
