// Every scene of the catalogue is free of faults, builds, and survives being written and read: the
// world made from the written text must have the same state hash. The hash itself is tested in
// tests/world.
#include "engine/scene/build.hpp"
#include "engine/scene/catalogue.hpp"
#include "engine/scene/writer.hpp"
#include "engine/world/world.hpp"
#include "tests/scene/scene_text.hpp"
#include "tests/support/scale.hpp"

using namespace tumble;

TEST_CASE("every shipped scene") {
  for (const CatalogueEntry& entry : scene_catalogue()) {
    CAPTURE(entry.name);
    const SceneRead read = open_scene(entry.name);
    INFO(all_text(read.faults));
    REQUIRE(read.ok());
    CHECK(!read.scene.title.empty());
    CHECK(!read.scene.description.empty());
    CHECK(!read.scene.cameras.empty());
    const SceneRead again = read_scene(write_scene(read.scene), entry.file.string());
    INFO(all_text(again.faults));
    REQUIRE(again.ok());
    if (test::only_to_run()) continue;  // the tests of snapshots build each scene
    std::vector<Fault> faults;
    WorldDef extras;
    extras.threads = 1;
    auto first = build_world(read.scene, extras, nullptr, &faults);
    INFO(all_text(faults));
    REQUIRE(first.ok());
    auto second = build_world(again.scene, extras);
    REQUIRE(second.ok());
    CHECK(first->world->state_hash() == second->world->state_hash());
  }
}
