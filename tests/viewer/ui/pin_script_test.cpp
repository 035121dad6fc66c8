// Values of the inspector that are pinned, and pulled in Settings whatever is selected. Reference:
// the world's own definitions.
#include "tests/viewer/ui/laboratory.hpp"
#include "viewer/ui/parameter_widgets.hpp"

using namespace tumble;
using namespace tumble::test;

namespace {

/// A wheel on a motor, and a ball.
struct PinnedLaboratory : Laboratory {
  PinnedLaboratory() {
    start = R"({
  "tumble_scene": 1,
  "bodies": {
    "ground": { "type": "static", "shape": { "type": "half_space" }, "material": "wood" },
    "ball": { "shape": { "type": "sphere", "radius": 0.5 }, "position": [0, 0.5, 0], "mass": 2 },
    "wheel": { "shape": { "type": "box", "size": [1, 1, 1] }, "position": [3, 2, 0] }
  },
  "joints": {
    "axle": { "kind": "revolute", "b": "wheel", "anchor": [3, 2, 0],
              "motor": { "velocity": 2, "max_force": 1000000 } }
  },
  "cameras": { "main": { "position": [0, 2.5, 9], "target": [0, 1.5, 0] } }
}
)";
    REQUIRE(write_file(file, std::string_view(start)).ok());
    rig.app->open(file);
    play("key B\nwait 3");
    rig.app->session().set_paused(true);
    play("wait 2\nclick body:ball\nwait 3\nclick inspector.group.1\nwait 3");
  }
  bool stands(const char* widget) const { return rig.app->locate(widget).has_value(); }
  void select(const char* name) {
    rig.app->ask(SelectBody{world().find_body(name)});
    play("wait 5");
  }
  BodyDef def(const char* name) { return *world().body_def(world().find_body(name)); }
  double target() { return world().joint(world().find_joint("axle"))->drives[0].motor.target; }
};

}  // namespace

TEST_CASE("a pinned value has a slider in Settings, at any time and whatever is selected") {
  PinnedLaboratory b;
  CHECK_FALSE(b.stands("pinned.ball.mass"));
  b.play("click inspector.mass.pin\nwait 2\nclick bar.settings\nwait 3");
  REQUIRE(b.stands("pinned.ball.mass"));
  b.select("wheel");
  b.play("drag pinned.ball.mass 20 0\nwait 3");
  const double pulled = b.def("ball").mass.value_or(0);
  CHECK(pulled > 2.05);
  CHECK(pulled < 4);  // the slider's end: twice the value it was pinned with
  b.play("key Ctrl+Z\nwait 3");
  CHECK(says(b.rig, "Taken back: Change mass of ball"));
  CHECK(b.def("ball").mass == 2);
  // While time runs it is a command.
  b.play("key Space\nwait 5\ndrag pinned.ball.mass 20 0\nwait 5\nkey Space\nwait 2");
  CHECK(b.rig.tick() > 5);
  CHECK(b.def("ball").mass.value_or(0) > 2.05);
  // Where the body is gone it says so, and the value is there again with it.
  b.select("ball");
  b.play("key Del\nwait 3");
  CHECK_FALSE(b.stands("pinned.ball.mass"));
  CHECK(b.stands("pinned.ball.off"));
  b.play("key Ctrl+Z\nwait 3");
  REQUIRE(b.stands("pinned.ball.mass"));
  b.play("click pinned.ball.mass.pin\nwait 3");
  CHECK_FALSE(b.stands("pinned.ball.mass"));
  CHECK(b.rig.app->ui_state().pins.all.empty());
  check_no_faults(*b.device);
}

TEST_CASE("numbers of shapes, materials and joints are pinned too, and end with their scene") {
  PinnedLaboratory b;
  b.play("click inspector.group.1\nwait 2\nclick inspector.shape.0\nwait 3");
  b.play("click inspector.shape.0.radius.pin\nclick inspector.shape.0.friction.pin\nwait 2");
  b.select("wheel");
  b.play("click joint.0\nwait 3\nclick joint.0.angle.target.pin\nwait 2");
  b.play("click bar.settings\nwait 3");
  REQUIRE(b.stands("pinned.ball.shape.0.radius"));
  REQUIRE(b.stands("pinned.ball.shape.0.friction"));
  REQUIRE(b.stands("pinned.axle.angle.target"));
  const uint64_t before = b.hash();
  b.play(
      "drag pinned.ball.shape.0.radius 10 0\ndrag pinned.ball.shape.0.friction 10 0\n"
      "drag pinned.axle.angle.target 90 0\nwait 3");
  CHECK(b.def("ball").shapes[0].shape.radius > 0.51);
  CHECK(b.def("ball").shapes[0].material.friction > 0.51);
  CHECK(b.target() > 2.05);
  CHECK(b.def("wheel").shapes[0].material.friction == 0.5);
  for (int i = 0; i < 3; ++i) b.play("key Ctrl+Z\nwait 2");
  CHECK(b.hash() == before);
  CHECK(b.target() == 2);
  CHECK(b.def("ball").shapes[0].shape.radius == 0.5);
  b.rig.app->open("second");
  b.play("wait 3");
  CHECK(b.rig.app->ui_state().pins.all.empty());
  check_no_faults(*b.device);
}

TEST_CASE("the ends of a slider are as far as twice the value, within what it may be") {
  CHECK(slider_range(2, 0, 1e15).least == 0);
  CHECK(slider_range(2, 0, 1e15).most == 4);
  CHECK(slider_range(0.4, 0, 1).most == 0.8);
  CHECK(slider_range(0.9, 0, 1).most == 1);
  CHECK(slider_range(-3, -1e9, 1e9).least == -6);
  CHECK(slider_range(-3, -1e9, 1e9).most == 6);
  CHECK(slider_range(0, -1e9, 1e9).most == 1);
}

TEST_CASE("a pin follows its body and its joint to another name") {
  PinnedLaboratory b;
  b.play("click inspector.mass.pin\nwait 2");
  b.select("wheel");
  b.play(
      "click joint.0\nwait 3\nclick joint.0.angle.target.pin\nwait 2\nclick bar.settings\nwait 3");
  b.select("ball");
  b.rig.app->ask(EditBody{b.world().find_body("ball"), "Rename ball",
                          [](BodyDef& def) { def.name = "marble"; }});
  b.play("wait 6");
  REQUIRE_FALSE(b.world().find_body("marble").is_null());
  CHECK(b.stands("pinned.marble.mass"));
  CHECK_FALSE(b.stands("pinned.ball.off"));
  b.rig.app->ask(
      EditDescription{ScenePath{} / "joints" / "axle", EditDescription::How::rename, "hub"});
  b.play("wait 6");
  REQUIRE_FALSE(b.world().find_joint("hub").is_null());
  CHECK(b.stands("pinned.hub.angle.target"));
  CHECK_FALSE(b.stands("pinned.axle.off"));
  CHECK(renamed_item("brick[3]", "brick", "stone") == "stone[3]");
  CHECK(renamed_item("bricks", "brick", "stone") == "bricks");
  check_no_faults(*b.device);
}

TEST_CASE("a pinned value that its owner has no more says so, and is taken off there") {
  PinnedLaboratory b;
  b.play("click inspector.mass.pin\nwait 2");
  b.select("wheel");
  b.play(
      "click joint.0\nwait 3\nclick joint.0.angle.target.pin\nwait 2\nclick bar.settings\nwait 3");
  REQUIRE(b.stands("pinned.axle.angle.target"));
  b.rig.app->ask(EditJoint{b.world().find_joint("axle"), "Change motor of axle",
                           [](JointDef& def) { def.drives[0].motor = {}; }});
  b.play("wait 5");
  CHECK_FALSE(b.stands("pinned.axle.angle.target"));
  REQUIRE(b.stands("pinned.axle.off"));
  b.play("click pinned.axle.off\nwait 3");
  CHECK_FALSE(b.stands("pinned.axle.off"));
  CHECK(b.rig.app->ui_state().pins.all.size() == 1);
  check_no_faults(*b.device);
}

TEST_CASE("a pin says which shape it is of, and that of a joint is one through both its bodies") {
  CHECK(label_of_pin({"ball", {}, "mass"}) == "ball: mass");
  CHECK(label_of_pin({"ball", {}, "shape.1.friction"}) == "ball: shape 1 friction");
  CHECK(label_of_pin({"ball", {}, "shape.0.euler_deg"}) == "ball: shape 0 turned about x, y, z");
  CHECK(label_of_pin({"wheel", "axle", "angle.target"}) == "axle: angle target");
  Pins pins;
  pins.flip({"wheel", "axle", "angle.target"});
  CHECK(pins.has({"frame", "axle", "angle.target"}));
  pins.flip({"frame", "axle", "angle.target"});
  CHECK(pins.all.empty());
  pins.flip({"ball", {}, "mass"});
  CHECK_FALSE(pins.has({"wheel", {}, "mass"}));
}
