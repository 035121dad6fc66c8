// One shipped scene (environment TUMBLE_SCENE; ctest has an entry for each): reads without faults;
// after every other tick of the first second, in the gate of a third of it, a snapshot loaded into
// a fresh world has the same next tick, byte for byte; and 1 and 4 threads give the same bits as 2.
// Reference: the same world, never saved.
#include "engine/core/bytes.hpp"
#include "engine/scene/build.hpp"
#include "engine/scene/reader.hpp"
#include "engine/world/shape_store.hpp"
#include "tests/support/test_world.hpp"
#include "tests/support/why_not.hpp"

#include <cstdlib>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

BuiltScene build(const SceneDescription& scene, int threads,
                 std::shared_ptr<ShapeStore> shapes = nullptr) {
  WorldDef def;
  def.threads = threads;
  auto built = build_world(scene, std::move(def), std::move(shapes));
  REQUIRE_MESSAGE(built.ok(), test::why_not(built));
  return std::move(*built);
}

/// The state alone: a loaded world begins a replay log of its own.
Bytes state_bytes(const World& world, const std::shared_ptr<ShapeStore>& shapes) {
  auto copy = World::create({}, shapes);
  REQUIRE(copy.ok());
  REQUIRE((*copy)->load(world.save(false)).ok());
  return (*copy)->save(false);
}

}  // namespace

TEST_CASE("scene: snapshots after each tick, and the same bits for every thread count") {
  const char* path = std::getenv("TUMBLE_SCENE");
  if (!path) return;  // started by hand, without a scene
  const SceneRead read = load_scene(path);
  for (const Fault& f : read.faults) FAIL_CHECK(f.text());
  REQUIRE(read.ok());
  const int ticks = test::graded_count(60, 20);

  auto shapes = std::make_shared<ShapeStore>();
  BuiltScene built = build(read.scene, 2, shapes);
  World& world = *built.world;
  for (int i = 0; i < ticks; ++i) {
    if (i % 2 == 1) {
      REQUIRE(world.step().ok());
      continue;
    }
    auto copy = World::create({}, shapes);
    REQUIRE(copy.ok());
    const Status loaded = (*copy)->load(world.save(i == 0));
    REQUIRE_MESSAGE(loaded.ok(), test::why_not(loaded));
    REQUIRE(world.step().ok());
    REQUIRE((*copy)->step().ok());
    const Bytes a = state_bytes(world, shapes), b = state_bytes(**copy, shapes);
    REQUIRE_MESSAGE(first_difference(a, b).empty(), "tick ", i, ", section ",
                    first_difference(a, b));
  }
  for (const int threads : {1, 4}) {
    BuiltScene other = build(read.scene, threads);
    for (int i = 0; i < ticks; ++i) REQUIRE(other.world->step().ok());
    CHECK(other.world->state_hash() == world.state_hash());
  }
}
