// What the event stepper promises in every scene: no contact is deeper than 1e-5 m beyond the depth
// that was accepted when it began. Reference: overlaps found anew by the narrow phase, which knows
// nothing of the stepper's contacts; besides, the world says so when it is not kept.
#include "engine/scene/build.hpp"
#include "engine/scene/reader.hpp"
#include "engine/world/world.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <doctest/doctest.h>

using namespace tumble;

TEST_CASE("no contact of a shipped scene of the event stepper is deeper than it may be") {
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(TUMBLE_SOURCE_DIR "/scenes")) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() != ".json" || name == "tumble.schema.json") continue;
    const SceneRead read = load_scene(entry.path().string());
    REQUIRE_MESSAGE(read.ok(), name);
    if (read.scene.settings.stepper != "event") continue;
    WorldDef def;
    def.log = [&name](LogLevel, std::string_view message) {
      CHECK_MESSAGE(message.find("deeper") == std::string_view::npos, name, ": ",
                    std::string(message));
    };
    auto scene = build_world(read.scene, std::move(def));
    REQUIRE_MESSAGE(scene.ok(), name);
    World& world = *scene->world;
    ++scenes;
    const auto deepest = [&world] {
      const std::vector<Overlap> all = world.overlaps(0);
      return all.empty() ? 0 : all.front().depth;
    };
    const double accepted = deepest();
    for (int i = 0; i * world.settings().tick.tick() < 1; ++i) {
      const auto report = world.step();
      REQUIRE(report.ok());
      if (report->stats.time_stepped > 0) break;  // promised of events only
      if (i % 5 == 0) CHECK_MESSAGE(deepest() < accepted + 1e-5, name, " at tick ", i);
    }
  }
  CHECK(scenes >= 8);
}
