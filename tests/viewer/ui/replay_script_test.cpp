// Replays of what was done in the window, saved and played again. References: the world that was
// shown, and the replay run without any window.
#include "engine/world/replay.hpp"
#include "engine/world/world.hpp"
#include "tests/viewer/ui/session_rig.hpp"
#include "viewer/app/scenes/scene_replay.hpp"
#include "viewer/capture/atomic_file.hpp"

#include <cstdlib>
#include <span>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr std::string_view scene_text = R"({
  "tumble_scene": 1,
  "parameters": { "high": { "value": 2, "min": 1, "max": 9, "doc": "where the ball begins [m]" } },
  "bodies": {
    "floor": { "type": "static", "shape": { "type": "half_space" } },
    "ball": { "position": [0, "$high", 0], "shape": { "type": "sphere", "radius": 0.3 } },
    "box": { "position": [1.5, 0.5, 0], "shape": { "type": "box", "size": [1, 1, 1] } }
  },
  "cameras": { "main": { "position": [1, 2, 9], "target": [1, 1, 0] } }
}
)";

/// A scene from a file, in which a person does something.
struct ReplayRig : Rig {
  std::filesystem::path file;
  explicit ReplayRig(Device& device) : Rig(device), file(folder.path() / "small.json") {
    setenv("XDG_CACHE_HOME", (folder.path() / "cache").c_str(), 1);
    REQUIRE(write_file(file, scene_text).ok());
    open(file);
  }
  void open(const std::filesystem::path& what) {
    app->open(what.string());
    play("wait 3\nkey Space\nwait 3");
  }
  void pull_gravity(double y) {
    WorldSettings settings = app->settings();
    settings.gravity = Vec3(0, y, 0);
    app->ask(ChangeSettings{settings});
  }
  /// A change of a setting, a deletion that is taken back, and a deletion.
  void work() {
    play("key Shift+.\nwait 3");
    pull_gravity(-4);
    play(
        "wait 2\nkey Shift+.\nwait 3\nclick body:ball\nwait 2\nkey Del\nwait 2\nkey Ctrl+Z\n"
        "wait 2\nkey Shift+.\nwait 3\nclick body:box\nwait 2\nkey Del\nwait 2\nkey .\nwait 3");
  }
  uint64_t hash() { return app->session().world().state_hash(); }
  std::filesystem::path saved(const char* name) const { return folder.path() / name; }
};

}  // namespace

TEST_CASE("what was done in the window is saved as a replay, up to the moment that is shown") {
  const auto device = make_null_device();
  ReplayRig rig(*device);
  rig.work();
  rig.play("key Ctrl+F9\nwait 3");
  CHECK(says(rig, "Replay of"));
  const auto bytes = read_file(rig.saved("tumble-small-replay-000.bin"));
  REQUIRE(bytes.ok());
  const auto replayed = run_replay(std::as_bytes(std::span(*bytes)));
  REQUIRE(replayed.ok());
  CHECK(replayed->same);
  CHECK(replayed->world->state_hash() == rig.hash());
  CHECK(replayed->world->tick() == rig.tick());
  CHECK(replayed->world->find_body("box").is_null());
  CHECK_FALSE(replayed->world->find_body("ball").is_null());
  // A moment before it, under another name; from the panel.
  rig.play("key Shift+,\nwait 2\nkey Shift+B\nwait 3\nclick bookmarks.replay\nwait 3");
  const auto earlier = read_file(rig.saved("tumble-small-replay-001.bin"));
  REQUIRE(earlier.ok());
  CHECK(run_replay(std::as_bytes(std::span(*earlier)))->world->state_hash() == rig.hash());
  check_no_faults(*device);
}

TEST_CASE("a pack from the window holds the scene with its numbers, and a replay that is played") {
  const auto device = make_null_device();
  ReplayRig rig(*device);
  rig.app->ask(ChangeParameter{"high", 3});
  rig.play("wait 3");
  rig.work();
  const uint64_t hash = rig.hash(), last = rig.tick();
  rig.play("key Ctrl+Shift+F9\nwait 3");
  CHECK(says(rig, "Replay of"));
  SceneRequest request;
  request.scene = rig.saved("tumble-small-replay-000.tumble").string();
  request.threads = 1;
  auto opened = open_scene(request, 1.6);
  REQUIRE(opened.ok());
  REQUIRE(opened->replay);
  CHECK(opened->parameters[0].value == 3);
  CHECK(opened->replay->last_tick() == last);
  CHECK(opened->replay->last_hash() == hash);
  // A replay alone says what its scene has to be given.
  rig.play("key Ctrl+F9\nwait 3");
  CHECK(says(rig, "--set parameters.high=3"));
  // What the file was saved with meanwhile does not matter: this world began before.
  rig.play("key Ctrl+S\nwait 3\nclick save.write\nwait 3\nkey Ctrl+Shift+F9\nwait 3");
  request.scene = rig.saved("tumble-small-replay-001.tumble").string();
  opened = open_scene(request, 1.6);
  REQUIRE(opened.ok());
  CHECK(opened->replay);
  check_no_faults(*device);
}

TEST_CASE("a scene with values that no file has is not packed with its replay, and it says why") {
  const auto device = make_null_device();
  ReplayRig rig(*device);
  rig.app->open(OpenRequest{rig.file.string(), {"bodies.ball.mass=3"}, {}});
  rig.play("wait 3\nkey Ctrl+Shift+F9\nwait 3");
  CHECK(says(rig, "bodies.ball.mass=3"));
  CHECK_FALSE(std::filesystem::exists(rig.saved("tumble-small-replay-000.tumble")));
}

TEST_CASE("the settings that are shown follow a replay, and R begins it again") {
  const auto device = make_null_device();
  ReplayRig rig(*device);
  rig.work();
  const uint64_t hash = rig.hash(), last = rig.tick();
  rig.play("key Ctrl+Shift+F9\nwait 3");
  rig.open(rig.saved("tumble-small-replay-000.tumble"));
  const auto shown = [&] { return rig.app->settings().gravity.now().y(); };
  const double of_scene = shown();
  CHECK(of_scene < -9);
  const auto to_the_end = [&] {
    rig.app->session().seek(last);
    rig.play("wait 4");
    CHECK(rig.hash() == hash);
    CHECK(shown() == -4);
  };
  to_the_end();
  rig.play("key Shift+,\nkey Shift+,\nkey Shift+,\nwait 3");
  CHECK(shown() == of_scene);
  to_the_end();
  // What the replay has changed is nobody's choice.
  rig.play("key R\nwait 4");
  CHECK(shown() == of_scene);
  to_the_end();
  // What a person has changed is.
  rig.pull_gravity(-1);
  rig.play("wait 3\nkey R\nwait 4");
  CHECK(shown() == -1);
  check_no_faults(*device);
}
