#pragma once
// Motion of frames in fifty digits, for central differences with steps so small that nothing but
// the derivative is left: h = 1e-12 leaves errors of 1e-24 in first and 1e-24 in second
// differences.
#include "engine/core/random.hpp"
#include "engine/math/triple.hpp"
#include "engine/math/types.hpp"

#include <boost/multiprecision/cpp_bin_float.hpp>

namespace tumble::test {

using Precise = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>,
                                              boost::multiprecision::et_off>;
using Precise3 = Triple<Precise>;

inline Precise3 precise(const Vec3& v) {
  return {Precise(v.x()), Precise(v.y()), Precise(v.z())};
}
inline Vec3 rounded(const Precise3& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
inline Precise length(const Precise3& v) {
  return sqrt(v.squared());
}
inline Precise3 unit(const Precise3& v) {
  return v * (1 / length(v));
}

/// A frame with constant acceleration whose angular velocity is omega, changing by alpha, at t = 0:
/// x(t) = x + v t + a t^2/2, R(t) = exp([omega t + alpha t^2/2]).
struct PreciseMotion {
  Vec3 x, v, a, omega, alpha;

  static PreciseMotion random(Random& r) {
    const auto draw = [&r](double size) {
      const double p = r.uniform(-size, size), q = r.uniform(-size, size);
      return Vec3(p, q, r.uniform(-size, size));
    };
    return {draw(1), draw(2), draw(5), draw(3), draw(5)};
  }
  /// An attached vector that is `r` at t = 0 (Rodrigues).
  Precise3 direction(const Vec3& r_world, const Precise& t) const {
    const Precise3 turn = precise(omega) * t + precise(alpha) * (t * t / 2), r = precise(r_world);
    const Precise square = turn.squared();
    if (square == 0) return r;
    const Precise angle = sqrt(square);
    return r + turn.cross(r) * (sin(angle) / angle) +
           turn.cross(turn.cross(r)) * ((1 - cos(angle)) / square);
  }
  /// An attached point that is at `p` at t = 0.
  Precise3 point(const Vec3& p, const Precise& t) const {
    return precise(x) + precise(v) * t + precise(a) * (t * t / 2) + direction(p - x, t);
  }
};

inline const Precise& difference_step() {
  static const Precise h("1e-12");
  return h;
}

/// d f/dt at 0, and d2 f/dt2, of anything with - and *.
template <class F>
auto central_rate(const F& f) {
  const Precise& h = difference_step();
  return (f(h) - f(-h)) * (1 / (2 * h));
}
template <class F>
auto central_second_rate(const F& f) {
  const Precise& h = difference_step();
  return ((f(h) - f(Precise(0))) - (f(Precise(0)) - f(-h))) * (1 / (h * h));
}

}  // namespace tumble::test
