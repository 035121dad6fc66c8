// Assertions of a scene and the list of events, in the window. Reference: the world itself, and
// free fall in closed form.
#include "tests/viewer/ui/session_rig.hpp"
#include "viewer/app/scenes/scene_assertions.hpp"

#include <cmath>
#include <fstream>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

std::string asserting_scene(const Rig& rig) {
  const std::string file = (rig.folder.path() / "asserting.json").string();
  std::ofstream(file) << R"({"tumble_scene": 1,
    "bodies": {
      "floor": {"type": "static", "shape": {"type": "half_space"}},
      "ball": {"position": [0, 1.5, 0], "shape": {"type": "sphere", "radius": 0.5}}
    },
    "sensors": {"thud": {"type": "contact", "a": "ball"}},
    "assertions": [
      {"title": "it falls", "holds": "bodies.ball.position.y < 1.4", "at": 0.2},
      {"title": "it stays up", "holds": "bodies.ball.position.y > 0.9", "always": true},
      "sensors.thud.count == 1"
    ],
    "look": {"overlays": ["sensors"]}})";
  return file;
}

}  // namespace

TEST_CASE("assertions wait, hold and fail in the panel as the world goes on, and back") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1200, 900, 1};
  CHECK_FALSE(rig.app->ui_state().shows(PanelId::assertions));
  rig.app->open(asserting_scene(rig));
  rig.play("key Space\nwait 2\nkey Shift+R\nwait 3");
  REQUIRE(rig.app->ui_state().shows(PanelId::assertions));
  const auto stands = [&](const char* mark) { return rig.app->ui().find(mark).has_value(); };
  rig.app->ask(SeekTick{0});
  rig.play("wait 3");
  REQUIRE(rig.tick() == 0);
  rig.play("key J\nwait 2");
  CHECK_FALSE(rig.app->ui_state().shows(PanelId::assertions));
  rig.play("key J\nwait 2");
  CHECK(stands("assertions.0.waiting"));
  CHECK(stands("assertions.1.holds"));
  CHECK(stands("assertions.2.waiting"));
  rig.app->ask(SeekTick{12});
  rig.play("wait 3");
  CHECK(stands("assertions.0.passed"));
  CHECK(stands("assertions.1.holds"));
  rig.app->ask(SeekTick{40});
  rig.play("wait 3");
  CHECK(stands("assertions.1.failed"));
  CHECK(stands("assertions.0.passed"));
  rig.app->ask(SeekTick{5});
  rig.play("wait 3");
  CHECK(stands("assertions.0.waiting"));
  CHECK(stands("assertions.1.holds"));
  check_no_faults(*device);
}

TEST_CASE("Ctrl+. goes to the impact of a falling ball, the list shows it and leads back to it") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1200, 900, 1};
  // The ball falls through 3.5 m.
  const double fall = std::sqrt(2 * 3.5 / 9.81);
  rig.play("key Space\nwait 2\nkey Ctrl+.\nwait 3");
  const uint64_t impact = rig.tick();
  CHECK(std::fabs(double(impact) / 60 - fall) < 0.04);
  CHECK(says(rig, "impact: ground against ball"));
  rig.play("key V\nwait 3");
  REQUIRE(rig.app->ui_state().shows(PanelId::events));
  CHECK(rig.app->ui().find("events.0"));
  CHECK_FALSE(rig.app->ui().find("events.1"));
  CHECK(rig.app->ui().find("timeline.events.1"));
  rig.play("key .\nkey .\nkey .\nwait 2\nclick events.0\nwait 3");
  CHECK(rig.tick() == impact);
  CHECK(rig.app->ui_state().event_filter.kind == WorldEventKind::impact);
  // What is behind does not remain when time goes back.
  rig.play("key ,\nkey ,\nwait 3");
  CHECK_FALSE(rig.app->ui().find("events.0"));
  rig.play("key Ctrl+.\nwait 3");
  CHECK(rig.tick() == impact);
  // A filter that nothing passes: it stops after a while and shows nothing.
  rig.app->ui_state().event_filter.least_impulse = 1e6;
  rig.play("wait 2");
  CHECK_FALSE(rig.app->ui().find("events.0"));
  rig.play("key Ctrl+.\nwait 3");
  CHECK(rig.tick() == impact + 20 * 60);
  CHECK(says(rig, "Nothing of this has happened in 20 s"));
  CHECK(says(rig, "impact of at least 1e+06 N s"));
  rig.app->ask(SeekTick{impact});
  rig.play("wait 3");
  rig.app->ui_state().event_filter = {std::nullopt, "BALL", 0};
  rig.play("wait 2");
  CHECK(rig.app->ui().find("events.0"));
  rig.app->ui_state().event_filter.body = "box";
  rig.play("wait 2");
  check_no_faults(*device);
}

TEST_CASE("sensors of a scene can be plotted without a body being selected") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1200, 900, 1};
  rig.app->open(asserting_scene(rig));
  rig.play("key Space\nwait 2\nkey P\nwait 3\nclick measure.choose\nwait 3");
  rig.play("click measure.thud:_count\nwait 3");
  REQUIRE(rig.app->measures().series().size() == 1);
  CHECK(rig.app->measures().series()[0].quantity.name == "thud: count");
  rig.play("key Ctrl+.\nwait 3");
  CHECK(rig.app->measures().series()[0].values.back() == 1);
  check_no_faults(*device);
}
