// Nearest points of slivers and needles, thinner and thinner. Reference: the same minimum over
// corners, sides and faces, by brute force with 100 decimal digits from the doubles given.
#include "engine/geometry/constructions/closest_points.hpp"
#include "tests/geometry/draws.hpp"

#include <algorithm>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <doctest/doctest.h>

using namespace tumble;

namespace {

using Long = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>,
                                           boost::multiprecision::et_off>;
using LongVec = std::array<Long, 3>;
using LongTriangle = std::array<LongVec, 3>;

LongVec long_vec(const Vec3& v) {
  return {Long(v.x()), Long(v.y()), Long(v.z())};
}
LongTriangle long_triangle(const std::array<Vec3, 3>& t) {
  return {long_vec(t[0]), long_vec(t[1]), long_vec(t[2])};
}
LongVec operator-(const LongVec& a, const LongVec& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
LongVec along(const LongVec& a, const Long& s, const LongVec& d) {
  return {a[0] + s * d[0], a[1] + s * d[1], a[2] + s * d[2]};
}
Long dot(const LongVec& a, const LongVec& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
LongVec cross(const LongVec& a, const LongVec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct Nearest {
  LongVec point;
  Long square = -1;
  void offer(const LongVec& p, const Long& s) {
    if (square < 0 || s < square) *this = {p, s};
  }
};

Long clamped(const Long& x) {
  return x < 0 ? Long(0) : x > 1 ? Long(1) : x;
}

Nearest reference(const LongVec& p, const LongTriangle& t) {
  Nearest out;
  for (size_t k = 0; k < 3; ++k) {
    const LongVec d = t[(k + 1) % 3] - t[k];
    const Long square = dot(d, d);
    const LongVec x = along(t[k], square > 0 ? clamped(dot(d, p - t[k]) / square) : Long(0), d);
    out.offer(x, dot(p - x, p - x));
  }
  const LongVec n = cross(t[1] - t[0], t[2] - t[0]);
  const Long square = dot(n, n);
  if (!(square > 0)) return out;
  for (size_t k = 0; k < 3; ++k) {
    if (dot(n, cross(t[(k + 1) % 3] - t[k], p - t[k])) < 0) return out;
  }
  const Long height = dot(n, p - t[0]) / square;
  out.offer(along(p, -height, n), height * height * square);
  return out;
}

/// Square of the distance of two sides: the parameters that minimise it, each clamped in turn.
Long sides_square(const LongVec& a, const LongVec& u, const LongVec& b, const LongVec& v) {
  const LongVec w = a - b, n = cross(u, v);
  const Long square = dot(n, n);
  Long best = -1;
  const auto offer = [&](const Long& s, const Long& t) {
    const LongVec d = along(a, s, u) - along(b, t, v);
    const Long x = dot(d, d);
    if (best < 0 || x < best) best = x;
  };
  if (square > 0) {
    const Long s = dot(cross(v, w), n) / square, t = dot(cross(u, w), n) / square;
    if (s >= 0 && s <= 1 && t >= 0 && t <= 1) offer(s, t);
  }
  const Long uu = dot(u, u), vv = dot(v, v);
  for (int end = 0; end < 2; ++end) {
    const LongVec on_a = along(a, Long(end), u), on_b = along(b, Long(end), v);
    offer(Long(end), vv > 0 ? clamped(dot(on_a - b, v) / vv) : Long(0));
    offer(uu > 0 ? clamped(dot(on_b - a, u) / uu) : Long(0), Long(end));
  }
  return best;
}

bool pierces(const LongVec& s0, const LongVec& s1, const LongTriangle& t) {
  const LongVec n = cross(t[1] - t[0], t[2] - t[0]), line = s1 - s0;
  const Long d0 = dot(n, s0 - t[0]), d1 = dot(n, s1 - t[0]);
  if (!(dot(n, n) > 0) || (d0 > 0 && d1 > 0) || (d0 < 0 && d1 < 0) || d0 == d1) return false;
  bool left = false, right = false;
  for (size_t k = 0; k < 3; ++k) {
    const Long turn = dot(line, cross(t[k] - s0, t[(k + 1) % 3] - s0));
    left = left || turn > 0;
    right = right || turn < 0;
  }
  return !(left && right);
}

Long reference(const LongTriangle& a, const LongTriangle& b) {
  Long best = -1;
  const auto offer = [&](const Long& x) {
    if (best < 0 || x < best) best = x;
  };
  for (size_t i = 0; i < 3; ++i) {
    if (pierces(a[i], a[(i + 1) % 3], b) || pierces(b[i], b[(i + 1) % 3], a)) return 0;
    offer(reference(a[i], b).square);
    offer(reference(b[i], a).square);
    for (size_t j = 0; j < 3; ++j)
      offer(sides_square(a[i], a[(i + 1) % 3] - a[i], b[j], b[(j + 1) % 3] - b[j]));
  }
  return best;
}

/// About 1 in size; its height or one of its sides 10^-power.
std::array<Vec3, 3> thin_triangle(Random& r, int kind, double power) {
  std::array<Vec3, 3> t = draws::triangle(r);
  const Vec3 small = std::pow(10.0, -power) * draws::direction(r);
  if (kind == 0) t[2] = t[0] + r.uniform() * (t[1] - t[0]) + small;
  if (kind == 1) t[1] = t[0] + small;
  if (kind == 2) t[2] = t[1] + r.uniform(0, 1e-3) * (t[1] - t[0]) + small;
  return t;
}

double off(const Vec3& x, const LongVec& exact) {
  const LongVec d = long_vec(x) - exact;
  return double(sqrt(dot(d, d)));
}

}  // namespace

TEST_CASE("nearest points of slivers are within 1e-12 of the pair's size of the exact ones") {
  Random r(46);
  const int n = draws::count(20000);
  int faces = 0;
  double worst = 0;
  for (int i = 0; i < n; ++i) {
    const auto t = thin_triangle(r, i % 4, r.uniform(2, i % 5 ? 8 : 15));
    Vec3 p = draws::in_box(r, 2);
    const double reach = std::pow(10.0, -r.uniform(0, 8));
    const Vec3 inside = t[0] + 0.3 * (t[1] - t[0]) + 0.3 * (t[2] - t[0]);
    if (i % 3 == 1) p = inside + reach * draws::direction(r);
    // Above the face, where only the normal says whether it is the nearest feature.
    const Vec3 across = (t[1] - t[0]).cross(t[2] - t[0]);
    if (i % 3 == 2) p = inside + reach * (across / across.stableNorm());
    const TrianglePoint found = closest_on_triangle(p, t[0], t[1], t[2]);
    const Nearest exact = reference(long_vec(p), long_triangle(t));
    faces += found.feature == TriangleFeature::face;
    worst = std::max(worst, off(found.point, exact.point));
    worst =
        std::max(worst, std::fabs(std::sqrt(found.squared_distance) - double(sqrt(exact.square))));
  }
  CAPTURE(worst);
  CHECK(worst < 1e-12);
  if (n > 1000) CHECK(faces > n / 10);
}

TEST_CASE("distances of pairs of slivers are within 1e-12 of their size of the exact ones") {
  Random r(47);
  const int n = draws::count(8000);
  int meet = 0;
  double worst = 0;
  for (int i = 0; i < n; ++i) {
    auto a = thin_triangle(r, i % 4, r.uniform(2, 8)),
         b = thin_triangle(r, i / 4 % 4, r.uniform(2, 8));
    if (i % 3) {  // through or near each other
      const Vec3 on_a = 0.4 * a[0] + 0.3 * a[1] + 0.3 * a[2],
                 on_b = 0.2 * b[0] + 0.4 * b[1] + 0.4 * b[2];
      const Vec3 shift =
          on_a - on_b + (i % 3 - 1) * std::pow(10.0, -r.uniform(3, 10)) * draws::direction(r);
      for (Vec3& c : b) c += shift;
    }
    if (i % 7 == 3) b = {a[0], a[2] + 1e-9 * draws::direction(r), a[1]};  // nearly the same
    const TrianglePair found = closest_triangle_triangle(a, b);
    const Long square = reference(long_triangle(a), long_triangle(b));
    meet += square == 0;
    worst = std::max(worst, std::fabs(std::sqrt(found.squared_distance) - double(sqrt(square))));
    worst = std::max(worst, std::fabs((found.on_a - found.on_b).norm() - double(sqrt(square))));
    // They lie on the triangles.
    worst = std::max(worst, double(sqrt(reference(long_vec(found.on_a), long_triangle(a)).square)));
    worst = std::max(worst, double(sqrt(reference(long_vec(found.on_b), long_triangle(b)).square)));
  }
  CAPTURE(worst);
  CHECK(worst < 1e-12);
  if (n > 1000) CHECK(meet > n / 20);
}
