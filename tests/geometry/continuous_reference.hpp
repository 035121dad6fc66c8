#pragma once
#include "engine/geometry/continuous_tests/moving.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

/// When linearly moving features first meet, in integers: every condition is a polynomial in time
/// of degree at most 4 with integer coefficients, and [0, 1] is halved, the earlier half first,
/// until a condition fails throughout (Bernstein coefficients of one sign) or the interval is
/// 2^-`depth` wide. Nothing is rounded; conditions that fail by less than what 2^-140 of the time
/// changes count as met. Where the plane vanishes at a moment the place is on an edge, tested
/// apart.
namespace tumble::exact {

namespace mp = boost::multiprecision;
using Number = mp::number<mp::cpp_int_backend<3072, 3072, mp::signed_magnitude, mp::checked, void>,
                          mp::et_off>;
constexpr int deepest = 140;

/// Bernstein coefficients on the current interval, up to a positive factor.
struct Polynomial {
  int degree = 0;
  std::array<Number, 5> b;

  bool zero() const {
    return std::all_of(b.begin(), b.begin() + degree + 1, [](const Number& x) { return x == 0; });
  }
  bool positive() const {
    return std::all_of(b.begin(), b.begin() + degree + 1, [](const Number& x) { return x > 0; });
  }
  bool negative() const {
    return std::all_of(b.begin(), b.begin() + degree + 1, [](const Number& x) { return x < 0; });
  }
  int changes() const {
    int out = 0, last = 0;
    for (int i = 0; i <= degree; ++i) {
      const int s = b[size_t(i)].sign();
      out += s * last < 0;
      if (s) last = s;
    }
    return out;
  }
  void halve(Polynomial& left, Polynomial& right) const {
    left.degree = right.degree = degree;
    std::array<Number, 5> row = b;
    for (int k = 0; k <= degree; ++k) {
      left.b[size_t(k)] = row[0] * (1 << (degree - k));
      right.b[size_t(degree - k)] = row[size_t(degree - k)] * (1 << (degree - k));
      for (int i = 0; i + k < degree; ++i) row[size_t(i)] += row[size_t(i + 1)];
    }
  }
};

/// Linear, quadratic ... in time, as powers.
using Powers = std::vector<Number>;
inline Powers times(const Powers& a, const Powers& b) {
  Powers out(a.size() + b.size() - 1, 0);
  for (size_t i = 0; i < a.size(); ++i) {
    for (size_t j = 0; j < b.size(); ++j) out[i + j] += a[i] * b[j];
  }
  return out;
}
inline Powers plus(Powers a, const Powers& b, int sign = 1) {
  if (a.size() < b.size()) a.resize(b.size(), 0);
  for (size_t i = 0; i < b.size(); ++i) a[i] += sign * b[i];
  return a;
}
using Powers3 = std::array<Powers, 3>;
inline Powers3 minus(const Powers3& a, const Powers3& b) {
  return {plus(a[0], b[0], -1), plus(a[1], b[1], -1), plus(a[2], b[2], -1)};
}
inline Powers dot(const Powers3& a, const Powers3& b) {
  return plus(plus(times(a[0], b[0]), times(a[1], b[1])), times(a[2], b[2]));
}
inline Powers3 cross(const Powers3& a, const Powers3& b) {
  const auto c = [&](size_t i, size_t j) { return plus(times(a[i], b[j]), times(a[j], b[i]), -1); };
  return {c(1, 2), c(2, 0), c(0, 1)};
}
inline Polynomial bernstein(const Powers& a) {
  static constexpr int choose[5][5] = {{1}, {1, 1}, {1, 2, 1}, {1, 3, 3, 1}, {1, 4, 6, 4, 1}};
  Polynomial out;
  out.degree = int(a.size()) - 1;
  for (int i = 0; i <= out.degree; ++i) {
    out.b[size_t(i)] = 0;
    for (int k = 0; k <= i; ++k) {
      out.b[size_t(i)] += a[size_t(k)] * (12 * choose[i][k] / choose[out.degree][k]);
    }
  }
  return out;
}

/// All of: zero[i] = 0, above[i] >= 0, strict[i] > 0.
struct Conditions {
  std::vector<Polynomial> zero, above, strict;
};

struct ExactContact {
  double lo = 0, hi = 0;  ///< rounded
};

inline std::optional<ExactContact> first_time(const Conditions& c, double begin = 0,
                                              double length = 1, int depth = 0) {
  bool all_zero = true, all_above = true, starts = true;
  for (const Polynomial& p : c.zero) {
    if (p.positive() || p.negative()) return std::nullopt;
    all_zero = all_zero && p.zero();
    starts = starts && p.b[0] == 0;
  }
  for (const Polynomial& p : c.above) {
    if (p.negative()) return std::nullopt;
    all_above = all_above && p.positive();
    starts = starts && p.b[0] >= 0;
  }
  for (const Polynomial& p : c.strict) {
    if (p.negative() || p.zero()) return std::nullopt;
    all_above = all_above && p.positive();
    starts = starts && p.b[0] > 0;
  }
  if (starts) return ExactContact{begin, begin};
  const bool crosses = c.zero.size() == 1 && c.zero[0].changes() == 1 && all_above;
  if (crosses && depth > 45) return ExactContact{begin, begin + length};
  if (depth == deepest) {
    for (const Polynomial& p : c.strict) {
      if (!p.positive()) return std::nullopt;
    }
    return ExactContact{begin, begin + length};
  }
  Conditions left, right;  // what holds throughout is left out
  left.zero.resize(c.zero.size());
  right.zero.resize(c.zero.size());
  for (size_t i = 0; i < c.zero.size(); ++i) c.zero[i].halve(left.zero[i], right.zero[i]);
  for (const Polynomial& p : c.above) {
    if (!p.positive()) p.halve(left.above.emplace_back(), right.above.emplace_back());
  }
  for (const Polynomial& p : c.strict) {
    if (!p.positive()) p.halve(left.strict.emplace_back(), right.strict.emplace_back());
  }
  if (const auto found = first_time(left, begin, length / 2, depth + 1)) return found;
  auto found = first_time(right, begin + length / 2, length / 2, depth + 1);
  if (found || depth > 0) return found;
  for (const Polynomial& p : c.zero) {
    if (p.b[size_t(p.degree)] != 0) return std::nullopt;
  }
  for (const Polynomial& p : c.above) {
    if (p.b[size_t(p.degree)] < 0) return std::nullopt;
  }
  for (const Polynomial& p : c.strict) {
    if (p.b[size_t(p.degree)] <= 0) return std::nullopt;
  }
  return ExactContact{1, 1};
}

/// Points with integer coordinates: doubles times a common power of two.
class Lattice {
 public:
  explicit Lattice(const std::vector<const MovingPoint*>& points) {
    for (const MovingPoint* p : points) {
      for (int k = 0; k < 3; ++k) {
        for (const double x : {p->start[k], p->end[k]}) {
          if (x != 0) least_ = std::min(least_, std::ilogb(x) - 52);
        }
      }
    }
  }
  Powers3 operator()(const MovingPoint& p) const {
    Powers3 out;
    for (int k = 0; k < 3; ++k) {
      const Number a = whole(p.start[k]), b = whole(p.end[k]);
      out[size_t(k)] = {a, b - a};
    }
    return out;
  }

 private:
  Number whole(double x) const {
    if (x == 0) return 0;
    const int e = std::ilogb(x) - 52;
    return Number(int64_t(std::scalbn(x, -e))) * Number(Number(1) << (e - least_));
  }
  int least_ = 2000;
};

inline void earlier(std::optional<ExactContact>& best, const std::optional<ExactContact>& other) {
  if (other && (!best || other->lo < best->lo)) best = other;
}

inline std::optional<ExactContact> point_on_edge(const Powers3& p, const Powers3& a,
                                                 const Powers3& b) {
  const Powers3 y = minus(p, a), z = minus(p, b), n = cross(y, z);
  Conditions c;
  for (const Powers& k : n) c.zero.push_back(bernstein(k));
  c.above.push_back(bernstein(plus({0}, dot(y, z), -1)));
  return first_time(c);
}

/// The coplanarity cubic and the conditions on the place, while there is a plane.
inline std::optional<ExactContact> in_common_plane(const Powers3& x, const Powers3& n,
                                                   const std::vector<Powers>& above) {
  Conditions c;
  c.strict.push_back(bernstein(dot(n, n)));
  c.zero.push_back(bernstein(dot(x, n)));
  for (const Powers& p : above) c.above.push_back(bernstein(p));
  return first_time(c);
}

inline std::optional<ExactContact> vertex_face(const MovingPoint& vertex,
                                               const MovingTriangle& face) {
  const Lattice lattice({&vertex, &face[0], &face[1], &face[2]});
  const Powers3 p = lattice(vertex), a = lattice(face[0]), b = lattice(face[1]),
                c = lattice(face[2]);
  const Powers3 u = minus(b, a), v = minus(c, a), x = minus(p, a), n = cross(u, v);
  const Powers first = dot(cross(x, v), n), second = dot(cross(u, x), n);
  const Powers third = plus(plus(dot(n, n), first, -1), second, -1);
  auto best = in_common_plane(x, n, {first, second, third});
  if (bernstein(dot(n, n)).positive()) return best;  // a plane at all times: edges are in it
  earlier(best, point_on_edge(p, a, b));
  earlier(best, point_on_edge(p, b, c));
  earlier(best, point_on_edge(p, c, a));
  return best;
}

inline std::optional<ExactContact> edge_edge(const MovingEdge& e, const MovingEdge& f) {
  const Lattice lattice({&e[0], &e[1], &f[0], &f[1]});
  const Powers3 a = lattice(e[0]), b = lattice(e[1]), c = lattice(f[0]), d = lattice(f[1]);
  const Powers3 u = minus(b, a), v = minus(d, c), x = minus(c, a), n = cross(u, v);
  const Powers s = dot(cross(x, v), n), t = dot(cross(x, u), n), square = dot(n, n);
  auto best = in_common_plane(x, n, {s, plus(square, s, -1), t, plus(square, t, -1)});
  if (bernstein(square).positive()) return best;
  earlier(best, point_on_edge(a, c, d));
  earlier(best, point_on_edge(b, c, d));
  earlier(best, point_on_edge(c, a, b));
  earlier(best, point_on_edge(d, a, b));
  return best;
}

}  // namespace tumble::exact
