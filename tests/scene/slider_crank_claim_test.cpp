// The scene slider_crank_spatial. References: the time to the crank's angle by the energy of its
// one freedom, integrated by Simpson's rule; its closed form for where the slider is; the figures
// of the IFToMM library of benchmarks.
#include "engine/world/world.hpp"
#include "tests/scene/shipped_scene.hpp"
#include "tests/support/spatial_slider_crank.hpp"

#include <algorithm>
#include <numbers>

#include <fmt/format.h>

using namespace tumble;
using namespace tumble::test;

TEST_CASE("slider_crank_spatial: it is where its energy has it, to the fourth order of the tick") {
  using Reference = SpatialSliderCrankReference;
  double before = 0;
  for (const double hz : {480.0, 960.0}) {
    BuiltScene s = shipped("slider_crank_spatial", {fmt::format("settings.tick_hz={}", hz)});
    const double energy = s.world->frame()->stats.energies.total();
    double angle = 0, late = 0, apart = 0, drift = 0;
    for (int k = 1; k <= 3 * hz; ++k) {
      REQUIRE(s.world->step().ok());
      const Quat& q = body(s, "arm").pose.q;
      angle += std::remainder(2 * std::atan2(q.x(), q.w()) - angle, 2 * std::numbers::pi);
      apart = std::max(apart, std::fabs(place(s, "slider").x() - Reference::slider_at(angle)));
      drift = std::max(drift, std::fabs(s.world->frame()->stats.energies.total() - energy));
      // Four times a second, as each of them costs an integral.
      if (k % int(hz / 4) == 0)
        late = std::max(late, std::fabs(Reference::time_to(angle) - k / hz));
      if (k == int(hz)) {
        CHECK(place(s, "slider").x() == doctest::Approx(.2124956).epsilon(5e-3));
        CHECK(angle == doctest::Approx(10.89762).epsilon(2e-3));
      }
    }
    MESSAGE(hz, " Hz: late by ", late, " s, slider off by ", apart, " m, energy by ", drift, " J");
    CHECK(late < 2e-6);
    CHECK(apart < 1e-9);
    CHECK(drift < 1e-6);
    if (before > 0) CHECK(late < before / 8);
    before = late;
  }
}
