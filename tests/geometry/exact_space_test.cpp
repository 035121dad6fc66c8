// Whole numbers of fixed size, and points where planes meet. Reference: the same by
// Boost.Multiprecision's rational numbers of any size, straight from the definitions.
#include "engine/geometry/decomposition/exact_space.hpp"

#include "engine/core/random.hpp"
#include "engine/geometry/triangle_mesh.hpp"
#include "tests/geometry/draws.hpp"

#include <boost/multiprecision/cpp_int.hpp>
#include <doctest/doctest.h>

using namespace tumble;

namespace {

using Rational = boost::multiprecision::cpp_rational;
using Point = std::array<Rational, 3>;

Point rational(const Vec3& p) {
  return {Rational(p.x()), Rational(p.y()), Rational(p.z())};
}
Point minus(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Rational dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

struct RationalPlane {
  Point normal;
  Rational offset;
  explicit RationalPlane(const std::array<Vec3, 3>& p)
      : normal(cross(minus(rational(p[1]), rational(p[0])), minus(rational(p[2]), rational(p[0])))),
        offset(dot(normal, rational(p[0]))) {}
};
Rational determinant(const Point& a, const Point& b, const Point& c) {
  return dot(a, cross(b, c));
}
/// By Cramer's rule.
Point meeting(const RationalPlane& p, const RationalPlane& q, const RationalPlane& r,
              const Rational& whole) {
  Point out;
  for (size_t k = 0; k < 3; ++k) {
    Point columns[3];
    for (size_t j = 0; j < 3; ++j) {
      columns[j] = {p.normal[j], q.normal[j], r.normal[j]};
      if (j == k) columns[j] = {p.offset, q.offset, r.offset};
    }
    out[k] = determinant(columns[0], columns[1], columns[2]) / whole;
  }
  return out;
}
int sign(const Rational& x) {
  return x > 0 ? 1 : x < 0 ? -1 : 0;
}

}  // namespace

TEST_CASE("sums, differences and products of whole numbers are those of any size") {
  using boost::multiprecision::cpp_int;
  Random random(3);
  const auto draw = [&] {
    const double size = std::ldexp(1.0, int(random.uniform(0, 108)));
    return random.uniform(0, 1) < 0.1 ? 0.0 : std::floor(random.uniform(-size, size));
  };
  for (int i = 0; i < draws::count(2000); ++i) {
    const double a = draw(), b = draw(), c = draw(), d = draw();
    const auto whole = [](double x) { return Integer<110>::from(x, 0); };
    const auto ours = (whole(a) * whole(b) - whole(c) * whole(d)) * (whole(a) + whole(d));
    const cpp_int exact =
        (cpp_int(a) * cpp_int(b) - cpp_int(c) * cpp_int(d)) * (cpp_int(a) + cpp_int(d));
    CHECK(ours.sign() == exact.sign());
    const double near = exact.convert_to<double>();
    CHECK(std::fabs(ours.estimate() - near) <= 0x1p-50 * std::fabs(near));
    // All of it, by what is left.
    const auto back = ours - (whole(a) * whole(b) - whole(c) * whole(d)) * whole(a);
    CHECK((back - (whole(a) * whole(b) - whole(c) * whole(d)) * whole(d)).sign() == 0);
  }
  CHECK(Integer<110>::from(0.75, -2).estimate() == 3);
  CHECK(Integer<110>::from(-0.8, -2).estimate() == -3);  // without its fraction
}

TEST_CASE("points where planes meet are on the side of a plane, and in the order, of rationals") {
  Random random(5);
  size_t on = 0, same = 0;
  for (const double step : {1.0, 0x1p-45}) {  // a lattice, where much coincides; and hardly rounded
    std::vector<Vec3> corners;
    for (int i = 0; i < 24; ++i) {
      Vec3 p;
      for (int k = 0; k < 3; ++k)
        p[k] = step * std::floor(random.uniform(-3, 4) / std::min(1.0, step));
      corners.push_back(step == 1 ? p : p / 4);
    }
    ExactSpace space(corners);
    std::vector<uint32_t> planes;
    std::vector<RationalPlane> exact;
    for (size_t i = 0; i + 2 < corners.size(); ++i) {
      const std::array<Vec3, 3> through{corners[i], corners[i + 1], corners[i + 2]};
      const RationalPlane plane(through);
      const uint32_t added = space.add_plane(through[0], through[1], through[2]);
      REQUIRE((added == no_index) == (dot(plane.normal, plane.normal) == 0));
      if (added == no_index) continue;
      planes.push_back(added);
      exact.push_back(plane);
    }
    std::vector<Point> points;
    for (const Vec3& c : corners) points.push_back(rational(c));
    for (int i = 0; i < 60; ++i) {
      const auto pick = [&] { return size_t(random.uniform(0, double(planes.size()) - 1e-9)); };
      const size_t p = pick(), q = pick(), r = pick();
      const Rational whole = determinant(exact[p].normal, exact[q].normal, exact[r].normal);
      if (whole == 0) continue;
      REQUIRE(space.add_point(planes[p], planes[q], planes[r]) == points.size());
      points.push_back(meeting(exact[p], exact[q], exact[r], whole));
      for (int k = 0; k < 3; ++k) {
        const double near = points.back()[size_t(k)].convert_to<double>();
        CHECK(std::fabs(space.at(uint32_t(points.size()) - 1)[k] - near) <=
              1e-15 * std::fabs(near));
      }
    }
    for (uint32_t x = 0; x < points.size(); ++x)
      for (size_t p = 0; p < planes.size(); p += 3) {
        const int side = sign(dot(exact[p].normal, points[x]) - exact[p].offset);
        CHECK(space.side(planes[p], x) == side);
        on += side == 0;
      }
    for (size_t p = 0; p + 1 < planes.size(); p += 2) {
      const auto line = space.along(planes[p], planes[p + 1]);
      const Point way = cross(exact[p].normal, exact[p + 1].normal);
      REQUIRE((line.sign == 0) == (dot(way, way) == 0));
      if (line.sign == 0) continue;
      CHECK(sign(way[size_t(line.axis)]) == line.sign);
      std::vector<uint32_t> met;
      for (uint32_t x = 0; x < points.size(); ++x)
        if (dot(exact[p].normal, points[x]) == exact[p].offset &&
            dot(exact[p + 1].normal, points[x]) == exact[p + 1].offset)
          met.push_back(x);
      for (const uint32_t a : met)
        for (const uint32_t b : met) {
          const int order = sign(dot(way, minus(points[a], points[b])));
          CHECK(space.order(line, a, b) == order);
          same += a != b && order == 0;
        }
    }
  }
  CHECK(on > 50);
  CHECK(same > 0);
}
