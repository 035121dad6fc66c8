// Lines and points as the device gets them. Reference: counts and positions by hand.
#include "viewer/render/marks.hpp"

#include <cmath>
#include <limits>

#include <doctest/doctest.h>

using namespace tumble;

TEST_CASE("marks are grouped by what happens behind surfaces") {
  const Vec3f a(0, 0, 0), b(1, 0, 0);
  const Vec4f white = Vec4f::Ones();
  const auto runs = line_runs({{a, b, white, 1, Occlusion::none},
                               {a, b, white, 2, Occlusion::faint},
                               {a, b, white, 3, Occlusion::hidden}});
  CHECK(runs.tested == 2);
  CHECK(runs.faint == 1);
  CHECK(runs.over == 1);
  REQUIRE(runs.all.size() == 4);
  CHECK(runs.all[0].width == 2);
  CHECK(runs.all[2].width == 2);
  CHECK(runs.all[2].colour[3] == doctest::Approx(0.25));
  CHECK(runs.all[3].width == 1);
  CHECK(point_runs({}).all.empty());
}

TEST_CASE("marks that are not finite are left out") {
  const Vec3f a(0, 0, 0), b(1, 0, 0);
  const float nan = std::nanf(""), inf = std::numeric_limits<float>::infinity();
  const Vec4f white = Vec4f::Ones();
  for (const Occlusion o : {Occlusion::none, Occlusion::faint, Occlusion::hidden}) {
    const auto lines = line_runs({{a, b, white, 1, o}, {a, {nan, 0, 0}, white, 1, o}});
    CHECK(lines.tested + lines.over == 1);
    const auto points = point_runs({{a, white, 1, o}, {{0, inf, 0}, white, 1, o}});
    CHECK(points.tested + points.over == 1);
  }
}

TEST_CASE("linear colours become sRGB bytes") {
  CHECK(rgba_bytes(Vec4f(1, 0, 0.21586f, 0.5f)) == 0x808000FFu);
  CHECK(rgba_bytes(Vec4f(2, -1, 0, 1)) == 0xFF0000FFu);
}
