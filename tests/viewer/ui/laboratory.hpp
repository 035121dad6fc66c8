#pragma once
#include "engine/world/world.hpp"
#include "tests/viewer/ui/session_rig.hpp"
#include "viewer/capture/atomic_file.hpp"

#include <fmt/format.h>

namespace tumble::test {

/// A person with an empty scene: everything is done by pointer and keys.
struct Laboratory {
  std::unique_ptr<Device> device = make_null_device();
  Rig rig{*device};
  std::string file = (rig.folder.path() / "mine.json").string();
  std::string start = R"({
  "tumble_scene": 1, // mine
  "bodies": {
    "ground": { "type": "static", "shape": { "type": "half_space" }, "material": "wood" }
  },
  "cameras": { "main": { "position": [0, 2.5, 9], "target": [0, 1.5, 0] } }
}
)";
  uint64_t start_hash = 0;
  int undo_steps = 0;

  Laboratory() {
    rig.picture = {2600, 2600, 1};
    REQUIRE(write_file(file, std::string_view(start)).ok());
    rig.app->session().set_paused(true);
    rig.app->open(file);
    rig.play("wait 3");
    REQUIRE(rig.tick() == 0);
    start_hash = hash();
    rig.play("key B\nwait 3");
  }

  World& world() { return rig.app->session().world(); }
  uint64_t hash() { return world().state_hash(); }
  void play(const std::string& text) { rig.play(text); }
  /// Where a point of the world is on the screen.
  std::string at(const Vec3& x) const {
    const Vec3 p = project(rig.app->camera().camera(), x, rig.picture.width, rig.picture.height);
    return fmt::format("{:.1f},{:.1f}", p.x(), p.y());
  }
  void set(const std::string& widget, const std::string& value) {
    play("double_click " + widget + "\ntext " + value + "\nkey Enter\nwait 2");
  }
  void set(const std::string& widget, const Vec3& value) {
    const char* axes[] = {".x", ".y", ".z"};
    for (int k = 0; k < 3; ++k) set(widget + axes[k], fmt::format("{:.6g}", value[k]));
  }
  /// A body on the free ground in front; what was put down is selected.
  void body(const std::string& shape, const std::string& name) {
    play("click build." + shape + "\nwait 2\nclick " + at({0, 0, 3.5}) +
         "\nwait 3\nkey Esc\nwait 3");
    REQUIRE_FALSE(world().find_body(name).is_null());
    REQUIRE(rig.app->selected() == world().find_body(name));
  }
  void type(const char* name) {
    play(fmt::format("click build.type\nwait 2\nclick build.type.{}\nwait 2", name));
  }
  void part(const std::string& kind, const std::string& place) {
    play("click build." + kind + "\nwait 2\nclick " + place + "\nwait 4\nkey Esc\nwait 2");
  }
  std::string content() const { return *read_file(file); }
  void save() { play("key Ctrl+S\nwait 3\nkey Ctrl+S\nwait 3"); }

  /// Saved, opened again and run, the world is the same; taken back, file and world are those of
  /// the start. Leaves the world that was built, after `ticks`.
  void check_round_trip(uint64_t ticks) {
    const uint64_t built = hash();
    save();
    const std::string saved = content();
    CHECK(saved != start);
    CHECK(saved.find("// mine") != std::string::npos);
    for (int i = 0; i < 500 && !says(rig, "nothing to take back"); ++i) rig.play("key Ctrl+Z");
    CHECK(hash() == start_hash);
    save();
    CHECK(content() == start);
    REQUIRE(write_file(file, std::string_view(saved)).ok());
    rig.app->open(file);
    rig.play("wait 3");
    REQUIRE(rig.tick() == 0);
    rig.play("wait 2");
    CHECK(hash() == built);
    REQUIRE(rig.app->session().advance(ticks).ok());
    rig.play("wait 2");
  }
};

inline Vec3 place(Laboratory& b, const char* name) {
  return b.world().body(b.world().find_body(name))->pose.x;
}

}  // namespace tumble::test
