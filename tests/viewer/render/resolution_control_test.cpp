// Reference: a machine made up here, whose pictures take a part that goes with the pixels and a
// part that does not.
#include "viewer/render/resolution_control.hpp"

#include <initializer_list>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

struct Machine {
  double fixed = 0.003, full = 0.02;  ///< [s]
  double seconds(float resolution) const {
    return fixed + full * double(resolution) * double(resolution);
  }
};

/// How often the resolution changes in so many pictures.
int changes(ResolutionControl& control, const Machine& machine, int pictures) {
  int n = 0;
  for (int i = 0; i < pictures; ++i) {
    const float before = control.resolution();
    control.see(machine.seconds(before));
    n += control.resolution() != before;
  }
  return n;
}

}  // namespace

TEST_CASE("pictures that are fluent keep all their pixels, one that is not among them too") {
  ResolutionControl control;
  CHECK(changes(control, {}, 500) == 0);
  control.see(2);
  CHECK(changes(control, {}, 500) == 0);
  CHECK(control.resolution() == 1);
}

TEST_CASE("slow pictures lose pixels until they are fluent, and stay so") {
  for (const double full : {0.04, 0.06, 0.09, 0.11}) {
    const Machine machine{0.003, full};
    ResolutionControl control;
    changes(control, machine, 200);
    CAPTURE(full);
    CHECK(control.resolution() < 1);
    CHECK(machine.seconds(control.resolution()) <= 1.0 / 30);
    CHECK(changes(control, machine, 2000) == 0);
  }
}

TEST_CASE("a machine too slow for any resolution ends at half, and no trial follows") {
  ResolutionControl control;
  changes(control, {0.05, 0.5}, 100);
  CHECK(control.resolution() == 0.5f);
  CHECK(changes(control, {0.05, 0.5}, 1000) == 0);
}

TEST_CASE("all pixels come back when there is time, within a few seconds") {
  ResolutionControl control;
  changes(control, {0.003, 0.2}, 50);
  REQUIRE(control.resolution() == 0.5f);
  changes(control, {0.003, 0.005}, 150);
  CHECK(control.resolution() == 1);
}

TEST_CASE("a load that comes and goes does not make pictures pulse") {
  ResolutionControl control;
  int n = 0;
  for (int round = 0; round < 100; ++round) {
    n += changes(control, {0.003, 0.09}, 20);   // in motion
    n += changes(control, {0.003, 0.001}, 40);  // and at rest
  }
  CHECK(n < 40);
}
