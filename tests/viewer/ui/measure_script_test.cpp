// Reference: free fall in closed form (the realtime stepper's own, v before x), and the world
// itself.
#include "tests/viewer/ui/laboratory.hpp"
#include "tests/viewer/ui/session_rig.hpp"
#include "viewer/capture/atomic_file.hpp"

#include <algorithm>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

TEST_CASE("a height and a speed are plotted tick by tick, and kept where time goes back") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1200, 900, 1};
  rig.play("key Space\nwait 2\nclick body:ball\nkey P\nwait 3\nclick measure.choose\nwait 3");
  rig.play("click measure.ball:_height\nwait 3\nclick measure.choose\nwait 3");
  rig.play("click measure.ball:_speed\nwait 3");
  const auto series = [&](size_t k) -> const Measures::Series& {
    return rig.app->measures().series().at(k);
  };
  REQUIRE(rig.app->measures().series().size() == 2);
  CHECK(series(0).quantity.unit == "m");
  const uint64_t from = rig.tick();
  rig.play("key .\nkey .\nkey .\nkey .\nwait 2");
  REQUIRE(series(0).values.size() == 5);
  for (size_t i = 0; i < 5; ++i) {
    const double t = double(from + i) / 60;
    CHECK(series(0).at[i] == doctest::Approx(t));
    CHECK(double(series(1).values[i]) == doctest::Approx(9.81 * t).epsilon(1e-4).scale(1));
    CHECK(double(series(0).values[i]) == doctest::Approx(4 - 0.5 * 9.81 * t * t).epsilon(2e-3));
  }
  rig.play("key ,\nkey ,\nwait 2");
  CHECK(series(0).values.size() == 5);
  CHECK(series(0).values[2] == float(rig.height("ball")));
  // On the same way again nothing is new.
  const std::vector<float> before = series(0).values;
  rig.play("key .\nwait 2\nkey .\nwait 2\nkey ,\nkey ,\nwait 2");
  CHECK(series(0).values == before);
  rig.play("click measure.csv\nwait 2");
  const auto csv = read_file(rig.folder.path() / "first_measures.csv");
  REQUIRE(csv.ok());
  CHECK(csv->starts_with("time [s],ball: height [m],ball: speed [m/s]\n"));
  CHECK(std::ranges::count(*csv, '\n') == 6);
  rig.play("click measure.0.close\nwait 2");
  REQUIRE(rig.app->measures().series().size() == 1);
  CHECK(series(0).quantity.name == "ball: speed");
  // What is changed here ends what lay ahead; what is gone has no value, and stops nothing.
  rig.play("key Del\nkey .\nkey .\nwait 2");
  CHECK(series(0).values.size() <= 3);
  check_no_faults(*device);
}

TEST_CASE("what was built in the window is found by name, to be plotted") {
  Laboratory b;
  b.play("click build.gate\nwait 2\nclick " + b.at({0, 0, 3.5}) + "\nwait 3\nkey Esc\nwait 3");
  b.body("sphere", "sphere");
  b.play("key P\nwait 3\nclick measure.search\nwait 2\ntext gate.forw\nwait 3");
  REQUIRE(b.rig.app->ui().find("measure.found.sensors.gate.forward"));
  b.play("key Enter\nwait 3\nclick measure.search\nwait 2\ntext sphere.position.y\nwait 3");
  REQUIRE(b.rig.app->ui().find("measure.found.bodies.sphere.position.y"));
  b.play("key Enter\nwait 3\nkey .\nwait 3");
  const auto& series = b.rig.app->measures().series();
  REQUIRE(series.size() == 2);
  CHECK(series[0].values.back() == 0);
  CHECK(series[1].quantity.unit == "m");
  CHECK(series[1].values.back() == float(b.rig.height("sphere")));
  check_no_faults(*b.device);
}
