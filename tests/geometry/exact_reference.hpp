#pragma once
#include "engine/geometry/primitive_tests/shapes.hpp"
#include "tests/geometry/draws.hpp"

#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

/// What real numbers answer, by other means than the engine's: shapes are convex hulls of points
/// with integer coordinates, integers have 512 bits and throw on overflow.
namespace tumble::exact {

namespace mp = boost::multiprecision;
using Int =
    mp::number<mp::cpp_int_backend<512, 512, mp::signed_magnitude, mp::checked, void>, mp::et_off>;
using Small = std::array<int64_t, 3>;
using Points = std::vector<Small>;

/// Whether the convex hulls of two point sets have a point in common: feasibility of
/// sum l_i a_i = sum m_j b_j, sum l = sum m = 1, l, m >= 0, by the first phase of the simplex
/// method with Bland's rule and integer pivots (Edmonds 1967; no rounding).
inline bool hulls_meet(const Points& a, const Points& b) {
  constexpr size_t rows = 5;
  const size_t n = a.size() + b.size();
  std::vector<std::vector<Int>> table(rows + 1, std::vector<Int>(n + 1, 0));
  for (size_t j = 0; j < n; ++j) {
    const bool of_a = j < a.size();
    const Small& p = of_a ? a[j] : b[j - a.size()];
    for (size_t k = 0; k < 3; ++k) table[k][j] = of_a ? p[k] : -p[k];
    table[of_a ? 3 : 4][j] = 1;
  }
  table[3][n] = table[4][n] = 1;
  for (size_t i = 0; i < rows; ++i) {
    for (size_t j = 0; j <= n; ++j) table[rows][j] -= table[i][j];
  }
  std::array<size_t, rows> basis{n, n + 1, n + 2, n + 3, n + 4};
  Int divisor = 1;
  for (;;) {
    size_t column = 0;
    while (column < n && table[rows][column] >= 0) ++column;
    if (column == n) return table[rows][n] == 0;
    size_t row = rows;
    for (size_t i = 0; i < rows; ++i) {
      if (table[i][column] <= 0) continue;
      if (row == rows) {
        row = i;
        continue;
      }
      const Int left = table[i][n] * table[row][column], right = table[row][n] * table[i][column];
      if (left < right || (left == right && basis[i] < basis[row])) row = i;
    }
    if (row == rows) return false;  // cannot happen: the sum of artificials is bounded
    const Int pivot = table[row][column];
    for (size_t i = 0; i <= rows; ++i) {
      if (i == row) continue;
      const Int factor = table[i][column];
      for (size_t j = 0; j <= n; ++j) {
        table[i][j] = (table[i][j] * pivot - factor * table[row][j]) / divisor;
      }
    }
    divisor = pivot;
    basis[row] = column;
  }
}

using IntVec = std::array<Int, 3>;
inline Int dot(const IntVec& a, const IntVec& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline IntVec minus(const IntVec& a, const IntVec& b) {
  return {Int(a[0] - b[0]), Int(a[1] - b[1]), Int(a[2] - b[2])};
}
inline IntVec cross(const IntVec& a, const IntVec& b) {
  return {Int(a[1] * b[2] - a[2] * b[1]), Int(a[2] * b[0] - a[0] * b[2]),
          Int(a[0] * b[1] - a[1] * b[0])};
}

/// Sign of distance(p, hull) - radius: the distance is the least over all simplices of up to three
/// of the points that hold the projection of p, 0 when the hull holds p.
inline int distance_sign(const Small& p, int64_t radius, const Points& hull) {
  if (hulls_meet({p}, hull)) return radius > 0 ? -1 : 0;
  std::vector<IntVec> q;
  for (const Small& h : hull) q.push_back({Int(h[0]) - p[0], Int(h[1]) - p[1], Int(h[2]) - p[2]});
  const Int square = Int(radius) * radius;
  int sign = 1;
  const auto offer = [&](const Int& numerator, const Int& denominator) {
    const Int right = square * denominator;
    if (numerator < right) sign = -1;
    if (numerator == right && sign > 0) sign = 0;
  };
  for (size_t i = 0; i < q.size(); ++i) {
    offer(dot(q[i], q[i]), 1);
    for (size_t j = i + 1; j < q.size(); ++j) {
      const IntVec u = minus(q[j], q[i]), m = cross(q[i], q[j]);
      const Int along = -dot(q[i], u), length = dot(u, u);
      if (along > 0 && along < length) offer(dot(m, m), length);
      for (size_t k = j + 1; k < q.size(); ++k) {
        const IntVec n = cross(u, minus(q[k], q[i]));
        const Int area = dot(n, n);
        if (area == 0) continue;
        if (dot(n, m) < 0 || dot(n, cross(q[j], q[k])) < 0 || dot(n, cross(q[k], q[i])) < 0) {
          continue;
        }
        const Int height = dot(n, q[i]);
        offer(height * height, area);
      }
    }
  }
  return sign;
}

/// A shape with integer coordinates, twice: for the reference and, times `scale`, in doubles.
inline Vec3 to_double(const Small& p, double scale) {
  return scale * Vec3(double(p[0]), double(p[1]), double(p[2]));
}
inline Small plus(const Small& a, const Small& b, int64_t factor = 1) {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}

/// Centre and three half axes.
struct Box {
  Small centre{};
  std::array<Small, 3> arms{};

  Points corners() const {
    Points out;
    for (int c = 0; c < 8; ++c) {
      Small p = centre;
      for (size_t k = 0; k < 3; ++k) p = plus(p, arms[k], c >> k & 1 ? 1 : -1);
      out.push_back(p);
    }
    return out;
  }
  OrientedBox in_doubles(double scale) const {
    OrientedBox out;
    out.centre = to_double(centre, scale);
    for (int k = 0; k < 3; ++k) out.half_axes.col(k) = to_double(arms[size_t(k)], scale);
    return out;
  }
};

}  // namespace tumble::exact
