// Reference: the state hash of the world before and after each undo step, poses by hand.
#include "engine/math/rotation.hpp"
#include "engine/world/world.hpp"
#include "tests/viewer/ui/session_rig.hpp"
#include "viewer/app/editing/edit_history.hpp"
#include "viewer/capture/atomic_file.hpp"

#include <algorithm>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

uint64_t state_of(Rig& rig) {
  return rig.app->session().world().state_hash();
}

Vec3 place_of(const Rig& rig, std::string_view name) {
  const Frame& f = *rig.app->view().to;
  for (size_t slot = 0; slot < f.body_slots(); ++slot)
    if (!f.body(slot).id.is_null() && f.info(slot).name == name) return f.body(slot).pose.x;
  return Vec3::Constant(NAN);
}

bool has(const Rig& rig, std::string_view name) {
  return place_of(rig, name).allFinite();
}

}  // namespace

TEST_CASE("a body that was deleted comes back, and goes again") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 5\nclick transport.pause\nclick body:box");
  const uint64_t whole = state_of(rig);
  rig.play("key Del");
  CHECK_FALSE(has(rig, "box"));
  const uint64_t without = state_of(rig);
  CHECK(without != whole);
  rig.play("key Ctrl+Z");
  CHECK(has(rig, "box"));
  CHECK(state_of(rig) == whole);
  CHECK(says(rig, "Taken back: Delete box"));
  rig.play("key Ctrl+Shift+Z");
  CHECK(state_of(rig) == without);
  rig.play("key Ctrl+Z\nkey Ctrl+Z");
  CHECK(state_of(rig) == whole);
  CHECK(says(rig, "nothing to take back"));
  check_no_faults(*device);
}

TEST_CASE(
    "a run that is begun again is without the undo steps of the one before, until they are back") {
  TestWorld w;
  (void)w.add(TestWorld::box_def({0, 2, 0}));
  SessionOptions options;
  options.paused = true;
  Session session(std::move(w.world), std::move(options));
  EditHistory history;
  using Ticks = std::vector<uint64_t>;
  (void)history.begin(session, "Shoot", 3, {});
  (void)history.begin(session, "Shoot", 7, {});
  CHECK(history.ticks_of_this_course() == Ticks{3, 7});
  history.begin_course();
  CHECK(history.ticks_of_this_course().empty());
  (void)history.begin(session, "Shoot", 2, {});
  CHECK(history.ticks_of_this_course() == Ticks{2});
  CHECK(history.ticks() == Ticks{3, 7, 2});
  CHECK(session.advance(0).ok());
  // Back to before the restart was undone, too: the last one of that run is taken back.
  REQUIRE(history.undo(session, {}));
  CHECK(history.ticks_of_this_course().empty());
  REQUIRE(history.undo(session, {}));
  CHECK(history.ticks_of_this_course() == Ticks{3});
  REQUIRE(history.redo(session, {}));
  CHECK(history.ticks_of_this_course().empty());
  CHECK(session.advance(0).ok());
}

TEST_CASE("undo while it runs goes back to the moment of the undo step, redo to where one was") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 20\nclick body:box\nkey Del");
  const uint64_t deleted_at = rig.tick();
  rig.play("wait 30\nclick transport.pause");
  const uint64_t later = rig.tick(), state_later = state_of(rig);
  rig.play("key Ctrl+Z");
  CHECK(rig.tick() < deleted_at + 1);
  CHECK(has(rig, "box"));
  rig.play("key Ctrl+Y");
  CHECK(rig.tick() == later);
  CHECK(state_of(rig) == state_later);
  // Who goes back and does something else cannot do again what came after.
  rig.play("key Ctrl+Z\nclick body:box\nkey Ctrl+D\nkey Ctrl+Y");
  CHECK(has(rig, "box"));
  CHECK(has(rig, "box_2"));
  CHECK(says(rig, "nothing to do again"));
}

TEST_CASE("a pull, a shot and a changed setting are one undo step each") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 30\nclick transport.pause");
  const uint64_t before = state_of(rig);
  rig.play("move body:box\npress left\nby 0 -4\nby 0 -4\nkey Space");
  for (int i = 0; i < 30; ++i) rig.play("by 0 -4");
  rig.play("release left\nwait 3\nkey Space");
  CHECK(place_of(rig, "box").y() > 0.55);
  rig.play("shift_click body:ball\nwait 3");
  CHECK(has(rig, "shot"));
  WorldSettings settings = rig.app->settings();
  settings.gravity = Vec3(0, -3, 0);
  rig.app->ask(ChangeSettings{settings});
  rig.play("wait 3");
  rig.play("key Ctrl+Z\nwait 2");
  CHECK(says(rig, "Taken back: Change gravity"));
  CHECK(rig.app->settings().gravity.now().y() < -9);
  CHECK(has(rig, "shot"));
  rig.play("key Ctrl+Z\nwait 2");
  CHECK_FALSE(has(rig, "shot"));
  rig.play("key Ctrl+Z\nwait 2");
  CHECK(says(rig, "Taken back: Pull box"));
  CHECK(state_of(rig) == before);
  rig.play("key Ctrl+Z\nwait 2");
  CHECK(says(rig, "nothing to take back"));
}

TEST_CASE("a copy stands beside its body, and what was done to it is done to the next") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 5\nclick transport.pause\nclick body:box\nkey Ctrl+D\nwait 2");
  const Vec3 box = place_of(rig, "box"), second = place_of(rig, "box_2");
  REQUIRE(second.allFinite());
  CHECK((second - box - Vec3(1.1, 0, 0)).norm() < 1e-6);
  Session& session = rig.app->session();
  const BodyId copy = session.world().find_body("box_2");
  CHECK(rig.app->selected() == copy);
  // Up a step, and turned a little: a winding stair.
  const Quat turn(axis_angle(Vec3::UnitY(), 0.5));
  const Pose step{Vec3(0.8, 0.3, 0.1), turn};
  const Pose first = session.world().body_def(session.world().find_body("box"))->pose;
  session.post([&](World& world) { CHECK(world.set_pose(copy, first * step).ok()); });
  rig.play("wait 2\nkey Ctrl+D\nwait 2");
  const auto third = session.world().body_def(session.world().find_body("box_3"));
  REQUIRE(third.has_value());
  const Pose expected = first * step * step;
  CHECK((third->pose.x - expected.x).norm() < 1e-12);
  CHECK(third->pose.q.angularDistance(expected.q) < 1e-7);
  rig.play("key Ctrl+Z\nkey Ctrl+Z");
  CHECK_FALSE(has(rig, "box_3"));
  CHECK_FALSE(has(rig, "box_2"));
  rig.play("key Esc\nkey Ctrl+D");
  CHECK(says(rig, "Select a body"));
}

TEST_CASE("what is taken back leaves a body selected that still stands") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1600, 900, 1};  // the panel of the body covers none of them
  rig.play("wait 5\nkey Space\nclick body:box\nwait 3");
  World& world = rig.app->session().world();
  const BodyId box = world.find_body("box");
  REQUIRE(rig.app->selected() == box);
  std::vector<BodyId> way = {box};
  for (int k = 0; k < 3; ++k) {
    rig.play("key Ctrl+D\nwait 3");
    way.push_back(rig.app->selected());
    REQUIRE(way[way.size() - 2] != way.back());
  }
  for (int k = 2; k >= 0; --k) {
    rig.play("key Ctrl+Z\nwait 3");
    CHECK(rig.app->selected() == way[size_t(k)]);
  }
  // In one go, too; and what was deleted is selected when it is there again.
  rig.play("key Ctrl+D\nwait 3\nkey Ctrl+D\nwait 3\nkey Ctrl+Z\nkey Ctrl+Z\nwait 3");
  CHECK(rig.app->selected() == box);
  rig.play("key Del\nwait 3");
  CHECK(rig.app->selected().is_null());
  rig.play("key Ctrl+Z\nwait 3");
  CHECK(rig.app->selected() == box);
  // Another selection that stands is not touched.
  rig.play("key Ctrl+D\nwait 3\nclick body:ball\nwait 3\nkey Ctrl+Z\nwait 3");
  CHECK(rig.app->selected() == world.find_body("ball"));
  check_no_faults(*device);
}

TEST_CASE("values of a body are changed in the panel, with one undo step for each pull") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1200, 1000, 1};
  rig.play("wait 5\nkey Space\nclick body:box\nwait 3\nclick inspector.group.1\nwait 3");
  const auto def = [&] {
    World& world = rig.app->session().world();
    return *world.body_def(world.find_body("box"));
  };
  const double mass = rig.app->session().world().body(rig.app->selected())->mass;
  CHECK(mass == doctest::Approx(1000));
  // Pulled to the right by 40 px: more, whatever the speed of the widget.
  rig.play("drag inspector.mass 40 0\nwait 2");
  const double heavier = rig.app->session().world().body(rig.app->selected())->mass;
  CHECK(heavier > 1.1 * mass);
  CHECK(heavier < 10 * mass);
  rig.play("click inspector.group.1\nwait 2\nclick inspector.shape.0\nwait 2");
  rig.play("drag inspector.shape.0.friction 40 0\nwait 2");
  CHECK(def().shapes[0].material.friction > 0.5);
  // What the material does not give is there to be changed as well, alone.
  CHECK_FALSE(def().shapes[0].material.rolling_friction);
  rig.play("drag inspector.shape.0.rolling_friction 40 0\nwait 2");
  CHECK(def().shapes[0].material.rolling_friction.value_or(0) > default_turning_friction);
  CHECK_FALSE(def().shapes[0].material.torsional_friction);
  CHECK(rig.app->session().world().body(rig.app->selected())->mass == heavier);
  // Typed.
  rig.play("click inspector.shape.0\nwait 2\nclick inspector.group.1\nwait 2");
  rig.play("double_click inspector.gravity_scale\ntext 0\nkey Enter\nwait 2");
  CHECK(def().gravity_scale == 0);
  rig.play("key Ctrl+Z\nwait 2");
  CHECK(says(rig, "Taken back: Change gravity scale of box"));
  CHECK(def().gravity_scale == 1);
  rig.play("key Ctrl+Z\nkey Ctrl+Z\nkey Ctrl+Z\nwait 2");
  CHECK_FALSE(def().shapes[0].material.rolling_friction);
  CHECK(rig.app->session().world().body(rig.app->selected())->mass == mass);
  rig.play("key Ctrl+Z\nwait 2");
  CHECK(says(rig, "nothing to take back"));
  check_no_faults(*device);
}

TEST_CASE("a number out of range is not taken, and the field says why") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1200, 900, 1};
  rig.play("wait 5\nkey Space\nclick body:box\nwait 3\nclick inspector.group.1\nwait 3");
  const uint64_t before = state_of(rig);
  const auto said = [&] { return rig.app->locate("inspector.mass.refused").has_value(); };
  rig.play("double_click inspector.mass\ntext -5\nkey Enter\nwait 2");
  CHECK(state_of(rig) == before);
  CHECK(said());
  CHECK(rig.app->ui_state().refused.words == "must be > 0 and <= 1e+15 kg, got -5 kg");
  rig.play("double_click inspector.mass\ntext 7\nkey Enter\nwait 2");
  CHECK(rig.app->session().world().body(rig.app->selected())->mass == doctest::Approx(7));
  CHECK_FALSE(said());
  // Long enough to be read, then it goes.
  rig.play("double_click inspector.mass\ntext 0\nkey Enter\nwait 300");
  CHECK(said());
  rig.play("wait 100");
  CHECK_FALSE(said());
  check_no_faults(*device);
}

TEST_CASE("numbers of a scene are pulled, and it is opened anew when they are let go") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1200, 900, 1};
  rig.play("wait 5\nkey Space\nclick bar.settings\nwait 3");
  rig.app->camera().orbit(80, 0);
  rig.play("wait 60");
  const Vec3 eye = rig.app->camera().camera().eye;
  const uint64_t tick = rig.tick();
  rig.play("move parameters.count\npress left\nby 500 0\nwait 2");
  CHECK(rig.wished.empty());
  rig.play("release left\nwait 3");
  CHECK(rig.wished == std::vector<std::string>{"parameters.count=10"});
  CHECK(rig.tick() == tick);
  CHECK(rig.app->session().paused());
  CHECK((rig.app->camera().camera().eye - eye).norm() < 1e-6);
  rig.play("double_click parameters.gap\ntext 0.25\nkey Enter\nwait 3");
  CHECK(std::ranges::find(rig.wished, "parameters.gap=0.25") != rig.wished.end());
  check_no_faults(*device);
}

TEST_CASE("bodies, joints and springs are built by clicks, and taken back one by one") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1200, 900, 1};
  rig.play("wait 5\nkey Space\nkey B\nwait 3\nclick build.cone\nwait 2\nclick body:box\nwait 3");
  World& world = rig.app->session().world();
  const BodyId box = world.find_body("box"), ball = world.find_body("ball"),
               cone = world.find_body("cone");
  REQUIRE_FALSE(cone.is_null());
  // Seen from 9 m: a cone of 1 m, on the face of the box that was clicked.
  const Vec3 face = place_of(rig, "cone") - place_of(rig, "box");
  CHECK(face.z() > 0.5);
  CHECK(std::abs(face.x()) < 0.5);
  CHECK(rig.app->selected() == cone);  // what was put down, and not what was clicked
  rig.play("click build.revolute\nwait 2\nclick body:cone\nwait 600");
  CHECK(says(rig, "Now the other body"));  // as long as it waits
  CHECK_FALSE(rig.app->ui_state().overlays.joints);
  rig.play("click body:ball\nwait 3");
  CHECK_FALSE(says(rig, "Now the other body"));
  CHECK(rig.app->ui_state().overlays.joints);  // what was joined is seen
  const JointId joint = world.find_joint("revolute_1");
  REQUIRE_FALSE(joint.is_null());
  const JointDef def = *world.joint(joint);
  CHECK(def.a == cone);
  CHECK(def.b == ball);
  // Both frames are one place, whose z axis leaves the cone towards the eye.
  const Pose on_a = world.body_def(cone)->pose * def.frame_a,
             on_b = world.body_def(ball)->pose * def.frame_b;
  CHECK((on_a.x - on_b.x).norm() < 1e-12);
  CHECK(on_a.direction(Vec3::UnitZ()).z() > 0.2);
  rig.play("click build.spring\nwait 2\nclick body:cone\nwait 2\nkey Esc\nwait 2\nclick body:ball");
  rig.play("wait 2\nclick body:cone\nwait 3");
  CHECK(rig.app->view().to->forces.size() == 1);
  rig.play("key Esc\nkey Ctrl+Z\nwait 2");
  CHECK(says(rig, "Taken back: Spring between ball and cone"));
  CHECK(rig.app->view().to->forces.empty());
  rig.play("key Ctrl+Z\nwait 2");
  CHECK(world.find_joint("revolute_1").is_null());
  rig.play("key Ctrl+Z\nwait 2");
  CHECK(world.find_body("cone").is_null());
  rig.play("click body:box\nwait 2");
  CHECK(rig.app->selected() == box);
  check_no_faults(*device);
}

TEST_CASE("the timeline goes to any tick that has been, with the same state as then") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.play("wait 30\nkey Space\nwait 2");
  const uint64_t half = rig.tick(), state = state_of(rig);
  rig.play("key Space\nwait 60\nkey Space\nwait 2");
  const uint64_t end = rig.tick();
  REQUIRE(end > half + 50);
  const auto line = rig.app->ui().find("timeline");
  REQUIRE(line);
  const auto at = [&](uint64_t tick) {
    const double share = double(tick) / double(end);
    return std::to_string(double(line->x) + share * double(line->width)) + "," +
           std::to_string(line->y + 20);
  };
  rig.play("click " + at(half) + "\nwait 5");
  CHECK(rig.tick() == half);
  CHECK(state_of(rig) == state);
  CHECK(rig.app->session().paused());
  rig.play("move " + at(half) + "\npress left\nby -60 0\nwait 3\nby 300 0\nwait 3\nrelease left");
  CHECK(rig.tick() > half);
  rig.play("click " + at(end) + "\nwait 5");
  CHECK(rig.tick() == end);
  // An undo step in the past ends the course that was.
  rig.play("click " + at(half) + "\nwait 5\nclick body:box\nkey Del\nwait 3\nclick " + at(end) +
           "\nwait 5");
  CHECK(rig.tick() == half);
  check_no_faults(*device);
}

TEST_CASE(
    "what was built and changed is saved to the scene's file, after a look at the difference") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1200, 900, 1};
  const std::string file = (rig.folder.path() / "mine.json").string();
  const std::string text = R"({
  "tumble_scene": 1, // mine
  "parameters": { "h": { "value": 2, "min": 1, "max": 5 } },
  "bodies": {
    "ground": { "type": "static", "shape": { "type": "half_space" } },
    "ball": { "shape": { "type": "sphere", "radius": 1 }, "position": [0, "$h", 0] }
  },
  "cameras": { "main": { "position": [0, 2, 9], "target": [0, 1, 0] } }
}
)";
  REQUIRE(write_file(file, std::string_view(text)).ok());
  const auto content = [&] { return *read_file(file); };
  rig.app->open(file);
  rig.play("key Space\nwait 3\nkey Ctrl+S\nwait 3");
  REQUIRE(rig.app->ui_state().shows(PanelId::save));
  rig.play("click save.write\nwait 2");
  CHECK(content() == text);
  const BodyId ball = rig.app->session().world().find_body("ball");
  rig.app->ask(EditBody{ball, "Change mass of ball", [](BodyDef& d) { d.mass = 3; }});
  rig.play("key B\nwait 3\nclick build.box\nwait 2\nclick body:ball\nwait 2\nkey Esc\nwait 2");
  rig.play(
      "click build.spherical\nwait 2\nclick body:ball\nwait 2\nclick 780,200\nwait 2\nkey Esc");
  rig.play("key Ctrl+S\nwait 3\nkey Ctrl+S\nwait 2");
  CHECK_FALSE(rig.app->ui_state().shows(PanelId::save));
  const std::string saved = content();
  CHECK(saved.find("// mine") != std::string::npos);
  CHECK(saved.find("\"$h\"") != std::string::npos);
  rig.app->open(file);
  rig.play("wait 3");
  World& world = rig.app->session().world();
  CHECK(world.body(world.find_body("ball"))->mass == doctest::Approx(3));
  REQUIRE(world.find_body("box"));
  CHECK_FALSE(world.find_joint("spherical_1").is_null());
  // Undo steps of the earlier session are the file's now: nothing to save.
  rig.play("key Ctrl+S\nwait 3\nclick save.write\nwait 2");
  CHECK(content() == saved);
  rig.app->ask(ChangeParameter{"h", 4});
  rig.play("wait 3\nkey Ctrl+S\nwait 3\nclick save.write\nwait 2");
  CHECK(content().find("\"value\": 4") != std::string::npos);
  check_no_faults(*device);
}

TEST_CASE("a camera that followed a deleted body follows none, and again when that is taken back") {
  const auto device = make_null_device();
  Rig rig(*device);
  const std::string file = (rig.folder.path() / "mine.json").string();
  const std::string text =
      R"({"tumble_scene": 1, "bodies": {"ball": {"shape": {"type": "sphere", "radius": 1}}},
  "cameras": {"main": {"position": [0, 2, 9], "target": [0, 1, 0], "follow": "ball"}}})";
  REQUIRE(write_file(file, std::string_view(text)).ok());
  rig.app->open(file);
  rig.play("key Space\nwait 3\nclick body:ball\nkey Del\nkey Ctrl+S\nwait 3\nkey Ctrl+S\nwait 2");
  CHECK(says(rig, "Saved to"));
  CHECK(read_file(file)->find("follow") == std::string::npos);
  rig.play("key Ctrl+Z\nkey Ctrl+S\nwait 3\nkey Ctrl+S\nwait 2");
  CHECK(read_file(file)->find("\"follow\": \"ball\"") != std::string::npos);
  check_no_faults(*device);
}

TEST_CASE("a number of the scene that was chosen anew is taken back and chosen again") {
  const auto device = make_null_device();
  Rig rig(*device);
  const std::string file = (rig.folder.path() / "mine.json").string();
  const std::string text = R"({"tumble_scene": 1, "parameters": {"h": {"value": 2, "min": 1}},
  "bodies": {"ball": {"shape": {"type": "sphere", "radius": 1}, "position": [0, "$h", 0]},
             "box": {"shape": {"type": "box", "size": [1, 1, 1]}, "position": [5, 1, 0]}},
  "cameras": {"main": {"position": [0, 2, 9], "target": [0, 1, 0]}}})";
  REQUIRE(write_file(file, std::string_view(text)).ok());
  rig.app->open(file);
  rig.play("key Space\nwait 3\nkey R\nwait 2");
  const auto mass = [&] {
    const World& world = rig.app->session().world();
    return world.body(world.find_body("ball"))->mass;
  };
  const BodyId ball = rig.app->session().world().find_body("ball");
  const double usual = mass();
  rig.app->ask(EditBody{ball, "Change mass of ball", [](BodyDef& d) { d.mass = 3; }});
  rig.play("wait 60");
  rig.app->ask(ChangeParameter{"h", 4});
  rig.play("wait 3");
  rig.app->ask(ChangeParameter{"h", 6});
  rig.play("wait 3");
  CHECK(rig.height("ball") == 6);
  rig.play("key Ctrl+Z\nwait 3");
  CHECK(says(rig, "Taken back: Change h"));
  CHECK(rig.height("ball") == 4);
  rig.play("key Ctrl+Z\nwait 3");
  // With what was done to the scene before, standing still as before.
  CHECK(rig.height("ball") == 2);
  CHECK(mass() == doctest::Approx(3));
  CHECK(rig.app->session().paused());
  CHECK(rig.wished.empty());
  // That, too, one by one.
  rig.play("key Ctrl+Z\nwait 3");
  CHECK(says(rig, "Taken back: Change mass of ball"));
  CHECK(rig.height("ball") == 2);
  CHECK(mass() == doctest::Approx(usual));
  rig.play("key Ctrl+Z\nwait 3");
  CHECK(says(rig, "nothing to take back"));
  rig.play("key Ctrl+Shift+Z\nwait 3");
  CHECK(mass() == doctest::Approx(3));
  rig.play("key Ctrl+Shift+Z\nwait 3");
  CHECK(says(rig, "Done again: Change h"));
  CHECK(rig.height("ball") == 4);
  // An undo step is taken back before the choice that it came after, and ends what could be done
  // again.
  rig.app->ask(EditBody{rig.app->session().world().find_body("ball"), "Change mass of ball",
                        [](BodyDef& d) { d.mass = 7; }});
  rig.play("wait 3\nkey Ctrl+Z\nwait 3");
  CHECK(mass() == doctest::Approx(3));
  CHECK(rig.height("ball") == 4);
  rig.play("key Ctrl+Shift+Z\nwait 3\nkey Ctrl+Shift+Z\nwait 3");
  CHECK(mass() == doctest::Approx(7));
  CHECK(rig.height("ball") == 4);
  CHECK(says(rig, "nothing to do again"));
  // Another scene has nothing of it.
  rig.app->open("second");
  rig.play("wait 3\nkey Ctrl+Z\nwait 3");
  CHECK(rig.app->scene_name() == "second");
  CHECK(says(rig, "nothing to take back"));
  check_no_faults(*device);
}

TEST_CASE(
    "what was done before a number of the scene changed is taken back undo step by undo step") {
  const auto device = make_null_device();
  Rig rig(*device);
  const std::string file = (rig.folder.path() / "mine.json").string();
  const std::string text = R"({"tumble_scene": 1, "parameters": {"h": {"value": 2, "min": 1}},
  "bodies": {"ball": {"shape": {"type": "sphere", "radius": 1}, "position": [0, "$h", 0]},
             "box": {"shape": {"type": "box", "size": [1, 1, 1]}, "position": [3, 1, 0]},
             "rod": {"shape": {"type": "box", "size": [1, 1, 1]}, "position": [-3, 1, 0]}},
  "cameras": {"main": {"position": [0, 2, 9], "target": [0, 1, 0]}}})";
  REQUIRE(write_file(file, std::string_view(text)).ok());
  rig.app->open(file);
  rig.play("key Space\nwait 3\nkey R\nwait 2");
  const auto there = [&](const char* name) {
    return !rig.app->session().world().find_body(name).is_null();
  };
  rig.play("click body:box\nwait 2\nkey Del\nwait 2\nclick body:rod\nwait 2\nkey Del\nwait 2");
  REQUIRE_FALSE(there("box"));
  REQUIRE_FALSE(there("rod"));
  // No wait: what was done just now counts, too.
  rig.app->ask(ChangeParameter{"h", 5});
  rig.play("wait 3");
  CHECK(rig.height("ball") == 5);
  CHECK_FALSE(there("box"));
  CHECK_FALSE(there("rod"));
  rig.play("key Ctrl+Z\nwait 3");
  CHECK(rig.height("ball") == 2);
  CHECK_FALSE(there("rod"));
  rig.play("key Ctrl+Z\nwait 3");
  CHECK(says(rig, "Taken back: Delete rod"));
  CHECK(there("rod"));
  CHECK_FALSE(there("box"));
  rig.play("key Ctrl+Z\nwait 3");
  CHECK(there("box"));
  rig.play("key Ctrl+Z\nwait 3");
  CHECK(says(rig, "nothing to take back"));
  rig.play("key Ctrl+Shift+Z\nwait 3");
  CHECK_FALSE(there("box"));
  CHECK(there("rod"));
  rig.play("key Ctrl+Shift+Z\nwait 3\nkey Ctrl+Shift+Z\nwait 3");
  CHECK_FALSE(there("rod"));
  CHECK(rig.height("ball") == 5);
  // The file is as it was all the time.
  const auto now = read_file(file);
  REQUIRE(now.ok());
  CHECK(*now == text);
  check_no_faults(*device);
}

TEST_CASE(
    "a restart keeps what was built, deleted and edited, and forgets what was pulled and shot") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1600, 900, 1};
  rig.play("wait 5\nkey Space\nclick body:box\nwait 3\nkey Ctrl+D\nwait 3");
  REQUIRE(has(rig, "box_2"));
  // While it falls: where it is by then is not where it begins.
  rig.play("key Space\nwait 20\nkey Space\nwait 3");
  const Vec3 fallen = place_of(rig, "ball");
  World& world = rig.app->session().world();
  rig.app->ask(EditBody{world.find_body("ball"), "Change mass of ball",
                        [](BodyDef& def) { def.mass = 77; }});
  rig.play("wait 3\nclick body:box\nwait 3\nkey Del\nwait 3\nshift_click body:ball\nwait 3");
  REQUIRE(has(rig, "shot"));
  REQUIRE_FALSE(has(rig, "box"));
  for (const char* key : {"key R", "key Shift+R"}) {
    rig.play(std::string(key) + "\nwait 3");
    CHECK(rig.tick() == 0);
    CHECK(has(rig, "box_2"));
    CHECK_FALSE(has(rig, "box"));
    CHECK_FALSE(has(rig, "shot"));
    CHECK(place_of(rig, "ball").y() == doctest::Approx(4));
    CHECK(place_of(rig, "ball").y() > fallen.y());
    CHECK(world.body(world.find_body("ball"))->mass == doctest::Approx(77));
  }
  // It goes the same way each time, and stepping back reaches the same beginning.
  const uint64_t begun = state_of(rig);
  rig.play("key Shift+.\nkey Shift+.\nwait 3\nkey R\nwait 3");
  CHECK(state_of(rig) == begun);
  rig.play("key Shift+.\nwait 3\nkey Shift+,\nwait 3");
  CHECK(rig.tick() == 0);
  CHECK(state_of(rig) == begun);
  // What is taken back after a restart is no more in the next one.
  rig.play("key Ctrl+Z\nwait 3\nkey Ctrl+Z\nwait 3");
  CHECK(says(rig, "Taken back: Delete box"));
  CHECK(has(rig, "box"));
  rig.play("key R\nwait 3");
  CHECK(has(rig, "box"));
  CHECK(has(rig, "box_2"));
  check_no_faults(*device);
}

TEST_CASE("after a change the contacts are not told until the next tick, and springs are listed") {
  const auto device = make_null_device();
  Rig rig(*device);
  rig.picture = {1400, 900, 1};
  const std::string file = (rig.folder.path() / "hung.json").string();
  REQUIRE(write_file(file, R"({"tumble_scene": 1,
    "bodies": {
      "ground": {"type": "static", "shape": {"type": "half_space"}},
      "box": {"position": [0, 0.5, 0], "shape": {"type": "box", "size": [1, 1, 1]}},
      "bob": {"position": [2, 2, 0], "shape": {"type": "sphere", "radius": 0.3}}},
    "forces": {
      "up": {"type": "spring", "a": {"point": [2, 4, 0]}, "b": {"body": "bob"}, "stiffness": 2000},
      "over": {"type": "spring", "a": {"body": "box"}, "b": {"body": "bob"}}},
    "cameras": {"main": {"position": [0, 2, 9], "target": [0, 1.2, 0]}}})")
              .ok());
  rig.app->open(file);
  const auto untold = [&] { return rig.app->ui().find("inspector.contacts.unknown").has_value(); };
  rig.play("wait 3\nkey Space\nclick body:box\nwait 3");
  CHECK_FALSE(untold());
  CHECK(rig.app->ui().find("inspector.spring.0"));
  CHECK_FALSE(rig.app->ui().find("inspector.spring.1"));
  rig.play("key G\nwait 2\ndrag handle:y 0 -40\nwait 3");
  CHECK(untold());
  rig.play("key .\nwait 3");
  CHECK_FALSE(untold());
  rig.play("key Esc\nclick body:bob\nwait 3\nclick inspector.spring.1\nwait 2");
  CHECK(rig.app->ui().find("inspector.spring.1.other"));
  rig.play("click inspector.spring.1.other\nwait 3");
  CHECK(rig.app->selected() == rig.app->session().world().find_body("box"));
  check_no_faults(*device);
}
