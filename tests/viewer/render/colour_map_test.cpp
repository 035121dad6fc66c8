// The colour map and the scale of legends. References: values of matplotlib's table of viridis, the
// lightness L* of CIE 1976, scales by hand.
#include "viewer/render/colour_map.hpp"

#include "viewer/render/colour_legend.hpp"
#include "viewer/render/labels.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

double lightness(const Vec3f& linear) {
  const double y =
      0.2126 * double(linear.x()) + 0.7152 * double(linear.y()) + 0.0722 * double(linear.z());
  return y > 0.008856 ? 116 * std::cbrt(y) - 16 : 903.3 * y;
}

void check_scale(double low, double high, double from, double to, double step) {
  const NiceScale s = nice_scale(low, high, true);
  CHECK(s.low == doctest::Approx(from));
  CHECK(s.high == doctest::Approx(to));
  CHECK(s.step == doctest::Approx(step));
}

}  // namespace

TEST_CASE("viridis is that of matplotlib within two hundredths") {
  const double table[][4] = {{0, 0.267004, 0.004874, 0.329415},
                             {0.25, 0.229739, 0.322361, 0.545706},
                             {0.5, 0.127568, 0.566949, 0.550556},
                             {0.75, 0.369214, 0.788888, 0.382914},
                             {1, 0.993248, 0.906157, 0.143936}};
  for (const auto& [u, r, g, b] : table)
    CHECK((viridis_srgb(u).cast<double>() - Vec3(r, g, b)).cwiseAbs().maxCoeff() < 0.02);
}

TEST_CASE("its lightness rises evenly") {
  double last = lightness(viridis_table()[0]);
  CHECK(last < 18);
  for (size_t i = 16; i < 256; i += 16) {
    const double l = lightness(viridis_table()[i]);
    CHECK(l - last > 3);
    CHECK(l - last < 7);
    last = l;
  }
  CHECK(lightness(viridis_table()[255]) > 88);
}

TEST_CASE("values beyond the scale have the colours of its ends") {
  CHECK(viridis_linear(-5, 0, 1) == viridis_table()[0]);
  CHECK(viridis_linear(7, 0, 1) == viridis_table()[255]);
  CHECK(viridis_linear(3, 3, 3) == viridis_linear(0.5, 0, 1));
  CHECK(viridis_linear(NAN, 0, 1).allFinite());
}

TEST_CASE("scales are in steps of 1, 2 or 5 times a power of ten, rounded outwards") {
  check_scale(0, 4.7, 0, 5, 1);
  check_scale(0.03, 0.93, 0, 1, 0.2);
  check_scale(480, 1020, 400, 1200, 200);
  check_scale(-3, 21, -5, 25, 5);
  check_scale(0, 5, 0, 5, 1);
  check_scale(0, 0, 0, 1, 0.2);
  check_scale(100, 100, 90, 110, 5);
  CHECK(nice_scale(0.3, 2.2, false).low == 0.3);
  const auto numbers = nice_scale(0, 3, true).numbers();
  REQUIRE(numbers.size() == 4);
  CHECK(numbers[3] == doctest::Approx(3));
  CHECK(nice_scale(0.25, 1.1, false).numbers().front() == doctest::Approx(0.4));
}

TEST_CASE("a legend stays in its area, in which its title and numbers have room") {
  const FontAtlas font = bake_default_font();
  for (const int height : {270, 720, 2160}) {
    UiDrawList ui;
    const std::array<float, 4> area{0, 0, float(height) * 16 / 9, float(height)};
    add_legends({{"water: speed", "m/s", 0, 3}, {"sand: age", "s", 0, 10}}, font, area, height, 1,
                ui);
    REQUIRE(!ui.vertices.empty());
    for (const UiVertex& v : ui.vertices) {
      CHECK(v.x >= 0);
      CHECK(v.x <= area[2]);
      CHECK(v.y >= area[1]);
      CHECK(v.y <= area[3]);
    }
  }
}
