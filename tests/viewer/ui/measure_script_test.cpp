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
  rig.play("wait 6\nkey .\nkey .\nkey .\nkey .\nwait 2");
  const size_t past = from;  // the ticks before it was added, which it gets
  REQUIRE(series(0).values.size() == past + 5);
  for (size_t i = 0; i < past + 5; ++i) {
    const double t = double(i) / 60;
    CHECK(series(0).at[i] == doctest::Approx(t));
    CHECK(double(series(1).values[i]) == doctest::Approx(9.81 * t).epsilon(1e-4).scale(1));
    CHECK(double(series(0).values[i]) == doctest::Approx(4 - 0.5 * 9.81 * t * t).epsilon(2e-3));
  }
  rig.play("key ,\nkey ,\nwait 2");
  CHECK(series(0).values.size() == past + 5);
  CHECK(series(0).values[past + 2] == float(rig.height("ball")));
  // On the same way again nothing is new.
  const std::vector<float> before = series(0).values;
  rig.play("key .\nwait 2\nkey .\nwait 2\nkey ,\nkey ,\nwait 2");
  CHECK(series(0).values == before);
  rig.play("click measure.csv\nwait 2");
  const auto csv = read_file(rig.folder.path() / "first_measures.csv");
  REQUIRE(csv.ok());
  CHECK(csv->starts_with("time [s],ball: height [m],ball: speed [m/s]\n"));
  CHECK(std::ranges::count(*csv, '\n') == 6 + long(past));
  rig.play("click measure.0.close\nwait 2");
  REQUIRE(rig.app->measures().series().size() == 1);
  CHECK(series(0).quantity.name == "ball: speed");
  // What is changed here ends what lay ahead; what is gone has no value, and stops nothing.
  rig.play("key Del\nkey .\nkey .\nwait 2");
  CHECK(series(0).values.size() <= past + 3);
  check_no_faults(*device);
}

TEST_CASE("a curve that is added late gets the past that it would have had") {
  // Pulls, an edit and a step back within the run: all of them are part of what has been.
  const std::string begin = "wait 2\nkey Space\nwait 1\nclick body:ball\nkey P\nwait 3\n";
  const std::string run =
      "key Space\nwait 8\nshift_click 380,160\nwait 22\nkey Space\nwait 2\nkey ,\nkey ,\nwait 2\n"
      "key Space\nwait 20\nkey Space\nwait 3\n";
  const std::string add =
      "click measure.choose\nwait 3\nclick measure.ball:_height\nwait 3\n"
      "click measure.choose\nwait 3\nclick measure.ball:_speed\nwait 12\n";
  const auto series_of = [&](const std::string& text) {
    const auto device = make_null_device();
    Rig rig(*device);
    rig.picture = {1200, 900, 1};
    rig.play(text);
    REQUIRE(rig.app->measures().series().size() == 2);
    check_no_faults(*device);
    return rig.app->measures().series();
  };
  const auto early = series_of(begin + add + run), late = series_of(begin + run + add);
  for (size_t k = 0; k < 2; ++k) {
    CHECK(early[k].at.size() > 30);
    CHECK(early[k].at == late[k].at);
    CHECK(early[k].values == late[k].values);
    CHECK_FALSE(late[k].wants_past);
  }
}

TEST_CASE("the past of a curve is made good where a moment was jumped to, and can be left out") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1200, 900, 1};
  rig.play("wait 2\nkey Space\nclick body:ball\nkey P\nwait 3\nclick measure.choose\nwait 3");
  rig.play("click measure.ball:_height\nwait 3");
  const auto& series = rig.app->measures().series();
  const size_t before = series[0].at.size();
  rig.app->session().seek(rig.tick() + 100);
  rig.frame();
  CHECK(series[0].wants_past);
  CHECK(series[0].at.size() <= before + 2);
  rig.app->ask(LeavePast{});
  rig.play("wait 20");
  CHECK(series[0].at.size() <= before + 2);
  rig.app->session().seek(rig.tick() + 50);
  rig.play("wait 20");
  CHECK(series[0].at.size() == size_t(rig.tick()) + 1);
  CHECK(std::ranges::is_sorted(series[0].at));
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
