#include "engine/geometry/constructions/narrow_triangle.hpp"

#include "engine/math/double_double.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// A vector in double-double arithmetic (about 106 bits).
struct WideVec3 {
  std::array<DoubleDouble, 3> x;
};

DoubleDouble minus(DoubleDouble a) {
  return {-a.high, -a.low};
}

WideVec3 between(const Vec3& from, const Vec3& to) {
  WideVec3 out;
  for (size_t k = 0; k < 3; ++k) two_sum(to[int(k)], -from[int(k)], out.x[k].high, out.x[k].low);
  return out;
}

WideVec3 wide_cross(const WideVec3& a, const WideVec3& b) {
  WideVec3 out;
  for (size_t k = 0; k < 3; ++k) {
    const size_t i = (k + 1) % 3, j = (k + 2) % 3;
    out.x[k] = a.x[i] * b.x[j] + minus(a.x[j] * b.x[i]);
  }
  return out;
}

DoubleDouble wide_dot(const WideVec3& a, const WideVec3& b) {
  return a.x[0] * b.x[0] + a.x[1] * b.x[1] + a.x[2] * b.x[2];
}

WideVec3 wide_normal(const std::array<Vec3, 3>& t) {
  return wide_cross(between(t[0], t[1]), between(t[0], t[2]));
}

}  // namespace

Vec3 narrow_triangle_weights(const Vec3& p, const std::array<Vec3, 3>& t) {
  const WideVec3 n = wide_normal(t);
  Vec3 out;
  for (size_t k = 0; k < 3; ++k) {
    const Vec3 &from = t[(k + 1) % 3], &to = t[(k + 2) % 3];
    out[int(k)] = wide_dot(n, wide_cross(between(from, to), between(from, p))).high;
  }
  return out;
}

std::optional<double> narrow_triangle_crossing(const Vec3& s0, const Vec3& s1,
                                               const std::array<Vec3, 3>& t) {
  const WideVec3 n = wide_normal(t);
  const DoubleDouble d0 = wide_dot(n, between(t[0], s0)), d1 = wide_dot(n, between(t[0], s1));
  if ((d0.high > 0 && d1.high > 0) || (d0.high < 0 && d1.high < 0)) return std::nullopt;
  const double whole = (d0 + minus(d1)).high;
  if (whole == 0) return std::nullopt;
  // The line passes through the triangle if it turns the same way about all three sides.
  const WideVec3 line = between(s0, s1);
  bool left = false, right = false;
  for (size_t k = 0; k < 3; ++k) {
    const double turn =
        wide_dot(line, wide_cross(between(s0, t[k]), between(s0, t[(k + 1) % 3]))).high;
    left = left || turn > 0;
    right = right || turn < 0;
  }
  if (left && right) return std::nullopt;
  return std::clamp(d0.high / whole, 0.0, 1.0);
}

}  // namespace tumble
