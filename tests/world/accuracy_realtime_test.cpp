// The accuracy cases (tests/support/accuracy/cases.hpp) under the realtime stepper at 60 Hz,
// through World. References: closed forms. The bounds are at most the least errors that Bullet,
// Box3D, Jolt and ODE's QuickStep were measured to make in the same cases.
#include "tests/support/accuracy/cases.hpp"
#include "tests/support/accuracy/tumble_case.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

CaseMaker realtime() {
  return tumble_maker(WorldSettings{}, {[](const std::string& message) { FAIL(message); }});
}

Vec3 level(double degrees) {
  const double a = degrees * M_PI / 180;
  return {std::cos(a), 0, std::sin(a)};
}

}  // namespace

TEST_CASE("realtime accuracy: a slab slides under rolling balls as the closed form says (A1)") {
  for (const double degrees : {0.0, 60.0, 205.0}) {
    CAPTURE(degrees);
    const RollingErrors e = a1_rolling(realtime(), 60, level(degrees), 4);
    CHECK(e.slab < 8.7e-4);  // Bullet 0.9e-3 to 3.6e-3
    CHECK(e.ball < 8.7e-4);
  }
}

TEST_CASE(
    "realtime accuracy: elastic balls gain no energy from being stiff, and lose little (A3)") {
  const GasErrors e = a3_gas(realtime(), 60, true, 10);
  CHECK(e.energy_end < 0.01);  // Bullet +.64, ODE +.26; the best of the others +.06
  CHECK(e.energy_end > -0.06);
  CHECK(e.energy_most < 0.06);
}

TEST_CASE("realtime accuracy: a block below the angle of friction stays where it is (A7)") {
  for (const double degrees : {0.0, 45.0, 100.0}) {
    CAPTURE(degrees);
    const Slide held = a7_slide(realtime(), 60, level(degrees), 0.45, 5);
    CHECK(std::hypot(held.distance, held.across) < 7e-6);
    CHECK(a7_slide(realtime(), 60, level(degrees), 0.51, 2).distance > 0.01);
  }
}

TEST_CASE("realtime accuracy: a box bears a thousand times its mass (A8)") {
  const SinkErrors e = a8_sink(realtime(), 60, 1000);
  CHECK(e.most < 0.05);  // the best of the others: 0.34 m
  CHECK(e.speed < 1e-6);
}

TEST_CASE("realtime accuracy: half of the heaps of balls overlap by less than a millimetre (A10)") {
  constexpr uint64_t draws = 17;
  std::vector<double> overlaps;
  for (uint64_t k = 0; k < draws; ++k)
    overlaps.push_back(a10_penetration(realtime(), 60, 3, 42 + k));
  std::ranges::sort(overlaps);
  CHECK(overlaps[draws / 2] < 1e-3);
  CHECK(overlaps.back() < 1.5e-2);  // the best of the others in one draw: 11 mm
}
