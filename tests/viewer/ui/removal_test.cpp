// What a deletion does to parts that stay. Reference: the description that is left, written out.
#include "viewer/app/editing/removal.hpp"

#include "engine/scene/reader.hpp"
#include "engine/world/world.hpp"
#include "tests/support/why_not.hpp"
#include "tests/viewer/ui/laboratory.hpp"

#include <doctest/doctest.h>

using namespace tumble;

namespace {

const std::string scene_text = R"({
  "tumble_scene": 1,
  "parameters": { "size": 0.5 },
  "bodies": {
    "ball": { "shape": { "type": "sphere", "radius": 0.5 }, "position": [0, 9, 9] },
    "box": { "shape": { "type": "box", "size": [1, 1, 1] } },
    "row": { "shape": { "type": "sphere", "radius": 0.1 }, "position": [50, 0, 0],
             "repeat": { "type": "stack", "count": 3, "step": [0.3, 0, 0] } }
  },
  "forces": { "pull": { "type": "attractor", "strength": 1, "bodies": ["ball", "box"] } },
  "particles": {
    "dust": { "detect": true },
    "flag": { "cloth": { "corner": [0, 9, 9], "across": [1, 0, 0], "down": [0, 0, 1], "columns": 4,
                         "rows": 4, "density": "= 2 * size",
                         "pins": ["left", { "row": 3, "column": 3, "body": "ball" }] } }
  },
  "emitters": {
    "sparks": { "particles": "dust", "rate": 1, "life": 1, "carrier": "ball" },
    "rain": { "particles": "dust", "rate": 1, "life": 1,
              "events": [{ "event": "collision", "emitter": "sparks", "dies": true }] }
  },
  "sensors": { "eye": { "type": "region", "radius": 2, "bodies": ["ball", "box"] } }
}
)";

}  // namespace

TEST_CASE("a part that loses a name is described anew, and can be changed afterwards") {
  const SceneRead read = read_scene(scene_text, "x.json");
  REQUIRE(read.ok());
  WorldDef extras;
  extras.threads = 1;
  auto built = build_world(read.scene, extras);
  REQUIRE(built.ok());
  World& world = *built->world;
  SceneDescription parts = parts_of(read.scene);
  const auto live = std::make_shared<LiveParts>(*built);
  PartsController controller;
  controller.open(std::make_shared<const SceneDescription>(parts), live);
  SceneFile file;
  file.text = scene_text;
  file.path = "x.json";
  const auto edits = std::make_shared<std::vector<SceneEdit>>();
  const Refusal told;
  const Removal removal(file, {edits}, edits, controller, told);
  for (const char* name : {"ball", "row[0]", "row[2]"}) {
    REQUIRE(world.destroy_body(world.find_body(name)).ok());
    removal.take(world, RemovedBody{name});
  }
  removal.finish(world);
  CHECK(told.take_told().size() == 5);
  for (const SceneEdit& edit : *edits) {
    if (const auto* gone = std::get_if<RemovedPart>(&edit))
      drop_part(parts, list_of(gone->part), gone->name);
    if (const auto* change = std::get_if<ChangedPart>(&edit))
      put_part(parts, change->name, change->after);
  }
  CHECK(parts.emitters.names() == std::vector<std::string>{"rain"});
  CHECK(parts.emitters.find("rain")->events[0].emitter.empty());
  CHECK(parts.particles.find("flag")->cloth[0].sheet.pins.size() == 1);
  const auto sensor = find_part(parts, "sensors", "eye");
  REQUIRE(sensor.has_value());
  for (const auto& [list, name] : {std::pair("emitters", "rain"),
                                   {"particles", "flag"},
                                   {"sensors", "eye"},
                                   {"forces", "pull"}}) {
    const PartDescription part = *find_part(parts, list, name);
    const Status done = live->set(world, parts, name, part, &part);
    const std::string shown_name = name;
    CHECK_MESSAGE(done.ok(), shown_name);
  }
  // The file has lost the names alone.
  const auto saved = save_edits(scene_text, "x.json", *edits);
  REQUIRE_MESSAGE(saved.ok(), test::why_not(saved));
  CHECK(saved->text.find("\"density\": \"= 2 * size\"") != std::string::npos);
  CHECK(saved->text.find("\"bodies\": [\"box\"]") != std::string::npos);
  CHECK(saved->text.find("\"ball\"") == std::string::npos);
  CHECK(saved->text.find("\"2\": { \"present\": false }") != std::string::npos);
}

TEST_CASE("whoever deletes the floor of a fluid is told that the scene does not open without it") {
  test::Laboratory b;
  REQUIRE(write_file(b.file, std::string_view(R"({
  "tumble_scene": 1,
  "bodies": {
    "ground": { "type": "static", "shape": { "type": "half_space" } },
    "shelf": { "type": "static", "shape": { "type": "box", "size": [1, 0.1, 1] }, "position": [9, 5, 0] }
  },
  "particles": { "water": { "fluid": {}, "fill": { "type": "lattice", "region": "box",
                            "centre": [0, 0.5, 0], "size": [0.4, 0.4, 0.4], "spacing": 0.1 } } }
})"))
              .ok());
  b.rig.app->open(b.file);
  b.play("key B\nwait 3");
  const auto remove = [&](const char* name) {
    b.rig.app->ask(SelectBody{b.world().find_body(name)});
    b.play("wait 3\nkey Del\nwait 4");
    REQUIRE(b.world().find_body(name).is_null());
  };
  remove("shelf");  // nothing needs it
  CHECK_FALSE(says(b.rig, "does not open again"));
  remove("ground");
  CHECK(says(b.rig, "does not open again"));
  CHECK(says(b.rig, "Ctrl+Z brings it back"));
  b.play("key Ctrl+Z\nwait 4");
  CHECK_FALSE(b.world().find_body("ground").is_null());
}
