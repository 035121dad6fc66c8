// Polygons cut into triangles. References: areas by the shoelace formula, and points that must lie
// in exactly one triangle.
#include "engine/geometry/constructions/triangulate_polygon.hpp"
#include "engine/math/det/det.hpp"
#include "tests/geometry/draws.hpp"

#include <numeric>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

double area(const std::vector<Vec3>& v, const std::vector<Triangle>& t, const Vec3& normal,
            bool& all_forward) {
  double sum = 0;
  for (const Triangle& c : t) {
    const double a = 0.5 * (v[c[1]] - v[c[0]]).cross(v[c[2]] - v[c[0]]).dot(normal);
    all_forward = all_forward && a > 0;
    sum += a;
  }
  return sum;
}

}  // namespace

TEST_CASE("star-shaped polygons in any plane: right area, no triangle turned") {
  Random random(95);
  for (int i = 0; i < draws::count(500); ++i) {
    const uint32_t n = 3 + random.below(i % 10 == 0 ? 200 : 20);
    const Quat q = draws::rotation(random);
    std::vector<Vec3> v;
    double expected = 0;
    for (uint32_t k = 0; k < n; ++k) {
      const double a = 2 * det::pi * k / n, r = random.uniform(0.2, 1);
      v.push_back(Vec3(r * det::cos(a), r * det::sin(a), 0));
    }
    for (uint32_t k = 0; k < n; ++k) expected += 0.5 * v[k].cross(v[(k + 1) % n]).z();
    if (i % 2) {
      for (Vec3& p : v) p = q * p;
    }
    std::vector<uint32_t> corners(n);
    std::iota(corners.begin(), corners.end(), 0u);
    std::vector<Triangle> out;
    triangulate_polygon(v, corners, out);
    CHECK(out.size() == n - 2);
    bool forward = true;
    const Vec3 normal = i % 2 ? q * Vec3::UnitZ() : Vec3::UnitZ();
    CHECK(area(v, out, normal, forward) == doctest::Approx(expected).epsilon(1e-12));
    CHECK(forward);
  }
}

TEST_CASE("corners on straight sides, combs, repeated and collinear corners") {
  std::vector<Triangle> out;
  bool forward = true;
  // A square with two extra corners on every side.
  std::vector<Vec3> square;
  for (int side = 0; side < 4; ++side) {
    const Vec3 from[4] = {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}};
    for (int k = 0; k < 3; ++k) {
      square.push_back(from[side] + (from[(side + 1) % 4] - from[side]) * k / 3);
    }
  }
  std::vector<uint32_t> corners(square.size());
  std::iota(corners.begin(), corners.end(), 0u);
  triangulate_polygon(square, corners, out);
  CHECK(area(square, out, Vec3::UnitZ(), forward) == doctest::Approx(9));
  // A comb of many teeth.
  std::vector<Vec3> comb;
  for (int k = 0; k < 40; ++k) comb.emplace_back(k, k % 2 ? 0.1 : 5, 0);
  comb.emplace_back(39, -1, 0);
  comb.emplace_back(0, -1, 0);
  double expected = 0;
  for (size_t k = 0; k < comb.size(); ++k) {
    expected += 0.5 * comb[k].cross(comb[(k + 1) % comb.size()]).z();
  }
  corners.resize(comb.size());
  std::iota(corners.begin(), corners.end(), 0u);
  out.clear();
  forward = true;
  triangulate_polygon(comb, corners, out);
  CHECK(area(comb, out, -Vec3::UnitZ(), forward) == doctest::Approx(-expected));
  CHECK(forward);
  // Nothing sensible to do, but defined.
  const std::vector<Vec3> line{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(3, 0, 0)};
  out.clear();
  triangulate_polygon(line, std::vector<uint32_t>{0, 1, 2, 3}, out);
  CHECK(out.size() == 2);
  triangulate_polygon(line, std::vector<uint32_t>{0, 0, 0, 0}, out);
  CHECK(out.size() == 4);
  triangulate_polygon(line, std::vector<uint32_t>{0, 1}, out);
  CHECK(out.size() == 4);
}
