// All that the scene's file says, changed in the window by pointer and keys. Reference: the file as
// it would be written by hand, byte for byte; states of the world before and after.
#include "engine/scene/build.hpp"
#include "engine/scene/outline/outline.hpp"
#include "tests/viewer/ui/described.hpp"

#include <algorithm>
#include <cmath>

using namespace tumble;
using namespace tumble::test;

TEST_CASE(
    "description: a body becomes kinematic, gets a course, copies and a label, and none again") {
  Described b(two_bodies);
  b.go("bodies.ball");
  b.add("type");
  b.choose("type", "kinematic");
  b.add("course");
  REQUIRE(b.rig.app->locate("description.x").has_value());  // it begins with one that works
  b.type_in("x", "= 0.5*sin(2*t)");
  b.play("click description.way.2\nwait 2");
  b.add("repeat");
  b.play("click description.way.2\nwait 2");
  b.add("look");
  b.add("label");
  b.type_in("label", "moved");
  CHECK(b.saved() ==
        with(b.start, R"("position": [0, 2, 0] })",
             R"x("position": [0, 2, 0], "type": "kinematic", )x"
             R"x("course": { "x": "= 0.5*sin(2*t)" }, )x"
             R"x("repeat": [{ "type": "grid", "count": [1, 1, 1], "spacing": [1.0, 1.0, 1.0] }], )x"
             R"x("look": { "label": "moved" } })x"));
  REQUIRE_FALSE(b.world().find_body("ball[0]").is_null());
  REQUIRE(b.rig.app->session().advance(60).ok());
  CHECK(b.world().body(b.world().find_body("ball[0]"))->pose.x.x() ==
        doctest::Approx(0.5 * std::sin(2 * b.world().time())));
  check_no_faults(*b.device);
}

TEST_CASE(
    "description: each change is one step of undo, back to the file and the world as they were") {
  Described b(two_bodies);
  b.go("bodies.ball");
  b.add("starts_asleep");
  b.add("inertia");
  b.play("click description.shape\nwait 2");
  b.choose("type", "box");
  CHECK(b.saved().find(R"("type": "box")") != std::string::npos);
  b.go("");
  b.add("materials");
  b.play("click description.add\nwait 4");
  b.add("friction");
  b.type_in("name", "mud");
  const uint64_t built_hash = b.hash();
  const std::string built = b.saved();
  CHECK(built.find(R"("starts_asleep": true)") != std::string::npos);
  CHECK(built.find(R"("materials": { "mud": { "friction": 0 } })") != std::string::npos);
  int steps = 0;
  for (; steps < 50 && !says(b.rig, "nothing to take back"); ++steps) b.play("key Ctrl+Z\nwait 4");
  CHECK(steps == 8);  // seven changes, of which saving has forgotten none
  CHECK(b.hash() == b.start_hash);
  CHECK(b.saved() == b.start);
  for (int i = 0; i < 7; ++i) b.play("key Ctrl+Shift+Z\nwait 4");
  CHECK(b.hash() == built_hash);
  CHECK(b.saved() == built);
  check_no_faults(*b.device);
}

TEST_CASE("description: what makes no scene yet is kept and said, and hurts nothing") {
  Described b(two_bodies);
  b.go("bodies.ball.shape");
  b.type_in("radius", "-1");
  CHECK(b.faulty());
  CHECK(b.hash() == b.start_hash);
  b.play("click description.way.2\nwait 2");
  b.type_in("position.y", "3");  // a second one, while the first is wrong
  CHECK(b.faulty());
  CHECK(b.hash() == b.start_hash);
  b.play("click description.shape\nwait 2");
  b.type_in("radius", "0.25");  // mended: both hold
  CHECK_FALSE(b.faulty());
  CHECK(place(b, "ball").y() == 3);
  b.play("key Ctrl+Z\nwait 4");
  CHECK(b.hash() == b.start_hash);
  // Thrown away it is as if nothing had been typed.
  b.go("bodies.ball.shape");
  b.type_in("radius", "-1");
  b.play("click description.draft.leave\nwait 3");
  CHECK_FALSE(b.faulty());
  // A name of nothing.
  b.go("bodies.ground");
  b.type_in("material", "unobtainium");
  CHECK(b.faulty());
  b.play("key Ctrl+Z\nwait 3");
  CHECK_FALSE(b.faulty());
  check_no_faults(*b.device);
}

TEST_CASE("description: cameras and light change at once at the moment that is shown") {
  Described b(two_bodies);
  REQUIRE(b.rig.app->session().advance(50).ok());
  b.play("wait 3");
  REQUIRE(b.rig.tick() == 50);
  const uint64_t now = b.hash();
  b.go("cameras.main");
  b.type_in("position.x", "4");
  CHECK(b.rig.tick() == 50);
  CHECK(b.hash() == now);
  CHECK(b.rig.app->camera().camera().eye.x() == doctest::Approx(4));
  // The way to this moment is still there to be stepped back.
  b.play("key ,\nwait 3");
  CHECK(b.rig.tick() == 49);
  b.play("key .\nwait 3");
  CHECK(b.hash() == now);
  b.go("");
  b.add("look");
  b.add("exposure");
  CHECK(b.rig.tick() == 50);
  CHECK(b.hash() == now);
  // What acts on bodies is computed again, to the same moment.
  b.go("bodies.ball");
  b.type_in("position.y", "2.5");
  CHECK(b.rig.tick() == 50);
  CHECK(b.hash() != now);
  check_no_faults(*b.device);
}

TEST_CASE(
    "description: what is named elsewhere is chosen, renamed everywhere and told when it goes") {
  Described b(two_bodies + R"(,
  "joints": { "pivot": { "kind": "spherical", "b": "ball", "anchor": [0, 3, 0] } },
  "assertions": [{ "holds": "joints.pivot.broken == 0" }])");
  b.go("cameras.main");
  b.add("follow");
  b.choose("follow", "ball", ".names");
  b.go("joints.pivot");
  b.type_in("name", "hook");
  std::string now = b.saved();
  CHECK(now.find(R"("follow": "ball")") != std::string::npos);
  CHECK(now.find(R"("hook": { "kind": "spherical")") != std::string::npos);
  CHECK(now.find("joints.hook.broken") != std::string::npos);
  b.go("bodies");
  b.play("click description.ball.remove\nwait 4");
  CHECK(says(b.rig, "joint hook"));
  CHECK(b.world().find_body("ball").is_null());
  b.play("key Ctrl+Z\nwait 4");
  CHECK_FALSE(b.world().find_body("ball").is_null());
  CHECK(b.saved() == now);
  check_no_faults(*b.device);
}

TEST_CASE("description: a number is declared, and pulled in Settings") {
  Described b(two_bodies);
  b.go("bodies.ball.shape");
  b.play("click description.radius.declare\nwait 4");
  const std::string now = b.saved();
  CHECK(now.find(R"("radius": "$radius")") != std::string::npos);
  CHECK(now.find(R"("parameters": { "radius": 0.5 })") != std::string::npos);
  CHECK(b.hash() == b.start_hash);
  b.play("click bar.settings\nwait 3");
  CHECK(b.rig.app->locate("parameters.radius").has_value());
  check_no_faults(*b.device);
}

TEST_CASE("description: parts and settings change in the running world, expressions by restart") {
  Described b(two_bodies + R"(,
  "forces": { "air": { "type": "linear_drag", "rate": 0.5 } })");
  REQUIRE(b.rig.app->session().advance(20).ok());
  b.play("wait 3");
  const uint64_t now = b.hash();
  b.go("forces.air");
  b.type_in("rate", "2");
  CHECK(b.rig.tick() == 20);
  CHECK(b.hash() == now);  // by a command: it acts from now on
  CHECK(b.saved() == with(b.start, "0.5 } }", "2.0 } }"));
  b.type_in("rate", "= 1 + 1");
  CHECK(b.rig.tick() == 20);
  CHECK(b.hash() != now);  // from the start on
  CHECK(b.saved().find("\"= 1 + 1\"") != std::string::npos);
  check_no_faults(*b.device);
}

TEST_CASE("description: a parameter is typed, written out and renamed, and its slider follows") {
  Described b(two_bodies + R"(,
  "parameters": { "gap": 2, "size": { "value": 0.5, "min": 0.1, "max": 4 } })");
  b.go("parameters");
  b.type_in("gap", "3");
  CHECK_FALSE(b.faulty());
  CHECK(b.saved().find(R"("gap": 3,)") != std::string::npos);
  b.play("click description.gap.more\nwait 2");
  REQUIRE(b.rig.app->locate("description.name").has_value());
  b.add("max");
  b.type_in("max", "5");
  CHECK(b.saved().find(R"("gap": { "value": 3, "max": 5 })") != std::string::npos);
  // What is typed afterwards holds against what was chosen by the slider.
  b.rig.app->ask(ChangeParameter{"size", 1});
  b.play("wait 4");
  REQUIRE(b.rig.wished == std::vector<std::string>{"parameters.size=1"});
  b.go("parameters.size");
  b.type_in("value", "2");
  CHECK(b.rig.wished.empty());
  // What was chosen follows a new name.
  b.rig.app->ask(ChangeParameter{"size", 3});
  b.play("wait 4");
  b.type_in("name", "width");
  CHECK(b.rig.wished == std::vector<std::string>{"parameters.width=3"});
  check_no_faults(*b.device);
}

TEST_CASE("description: a draft is taken back before what was done earlier, and after what later") {
  Described b(two_bodies);
  b.go("bodies.ball.shape");
  b.type_in("radius", "-1");
  REQUIRE(b.faulty());
  b.play("click " + b.at({0, 2, 0}) + "\nwait 3");
  REQUIRE(b.rig.app->selected() == b.world().find_body("ball"));
  b.play("key Del\nwait 4");
  REQUIRE(b.world().find_body("ball").is_null());
  b.play("key Ctrl+Z\nwait 4");
  CHECK_FALSE(b.world().find_body("ball").is_null());
  CHECK(b.faulty());
  b.play("key Ctrl+Z\nwait 4");
  CHECK_FALSE(b.faulty());
  check_no_faults(*b.device);
}

TEST_CASE("description: another scene is not opened over a draft without being asked for") {
  Described b(two_bodies);
  b.go("bodies.ball.shape");
  b.type_in("radius", "-1");
  b.rig.app->open(b.file);
  b.play("wait 4");
  REQUIRE(b.rig.app->ui().find("question.stay"));
  b.play("click question.stay\nwait 4");
  CHECK(b.faulty());
  b.rig.app->open(b.file);
  b.play("wait 4\nclick question.leave\nwait 4");
  CHECK_FALSE(b.faulty());
  check_no_faults(*b.device);
}

TEST_CASE("description: values of a body change it in the running world, as its own panel does") {
  Described b(
      with(two_bodies, "\"position\": [0, 2, 0]", "\"gravity_scale\": 1, \"position\": [0, 2, 0]"));
  REQUIRE(b.rig.app->session().advance(20).ok());
  b.play("wait 3");
  const uint64_t now = b.hash();
  const auto ball = [&] { return *b.world().body_def(b.world().find_body("ball")); };
  const Pose pose = ball().pose;
  b.go("bodies.ball.shape");
  b.type_in("radius", "0.25");
  CHECK(b.rig.tick() == 20);
  REQUIRE(ball().shapes.size() == 1);
  CHECK(ball().shapes[0].shape.radius == 0.25);
  CHECK(ball().pose.x == pose.x);  // where it has fallen to
  CHECK(ball().velocity.y() < -1);
  CHECK(b.saved() == with(b.start, "0.5 }", "0.25 }"));
  b.go("bodies.ball");
  b.type_in("gravity_scale", "0");
  CHECK(ball().gravity_scale == 0);
  const double speed = ball().velocity.y();
  CHECK(speed < -1);  // it has fallen until now
  REQUIRE(b.rig.app->session().advance(10).ok());
  CHECK(ball().velocity.y() == doctest::Approx(speed));  // from now on
  b.play("wait 3");
  for (int i = 0; i < 2; ++i) b.play("key Ctrl+Z\nwait 4");
  CHECK(b.hash() == now);
  CHECK(b.saved() == b.start);
  // How it begins is a matter of the start.
  b.type_in("position.y", "3");
  CHECK(b.rig.tick() == 20);
  CHECK(ball().pose.x.y() == doctest::Approx(pose.x.y() + 1));
  check_no_faults(*b.device);
}

TEST_CASE(
    "description: items of a list change places, in the file and in the choices of the user") {
  Described b(with(two_bodies, R"("shape": { "type": "sphere", "radius": 0.5 })",
                   R"("shapes": [
      { "type": "sphere", "radius": 0.5 }, // low
      { "type": "sphere", "radius": 0.2, "position": [0, 0.5, 0] }
    ])"));
  b.go("bodies.ball.shapes");
  CHECK_FALSE(b.rig.app->locate("description.2.up").has_value());
  b.play("click description.0.up\nwait 4");  // nothing is above it
  CHECK(b.saved() == b.start);
  b.play("click description.0.down\nwait 4");
  const std::string expected = with(b.start, R"({ "type": "sphere", "radius": 0.5 }, // low
      { "type": "sphere", "radius": 0.2, "position": [0, 0.5, 0] }
)",
                                    R"({ "type": "sphere", "radius": 0.2, "position": [0, 0.5, 0] },
      { "type": "sphere", "radius": 0.5 } // low
)");
  CHECK(b.saved() == expected);
  b.play("click description.1.up\nwait 4");
  CHECK(b.saved() == b.start);
  b.play("key Ctrl+Z\nwait 4");
  CHECK(b.saved() == expected);
  check_no_faults(*b.device);
}

TEST_CASE("description: keys and text that come in one slow picture keep their order") {
  Described b(two_bodies);
  b.go("bodies.ball.shape");
  b.play("click description.radius\nwait 2");
  std::vector<InputEvent> events;
  const auto tap = [&](Key key) {
    events.push_back(KeyPressed{key, true});
    events.push_back(KeyPressed{key, false});
  };
  const auto write = [&](std::string_view text) {
    for (const char c : text) {
      events.push_back(KeyPressed{Key(c), true});
      events.push_back(TextTyped{uint32_t(c)});
      events.push_back(KeyPressed{Key(c), false});
    }
  };
  events.push_back(KeyPressed{Key::control, true});
  tap(Key::a);
  events.push_back(KeyPressed{Key::control, false});
  write("0.73");
  tap(Key::backspace);
  tap(Key::backspace);
  write("25");
  tap(Key::left);
  write("1");
  tap(Key::enter);
  b.rig.frame(events);
  b.play("wait 20");
  CHECK(b.saved() == with(b.start, "0.5 }", "0.215 }"));
  check_no_faults(*b.device);
}

TEST_CASE("description: long numbers get a line of their own, and all of a text is told") {
  Described b(
      with(two_bodies, "\"ball\": { \"shape\"",
           "\"ball\": { \"look\": { \"label\": \"a label of very many letters, which no field "
           "of this panel can show whole\" }, \"shape\""));
  b.go("bodies.ball");
  const auto place = [&](const std::string& mark) {
    const auto r = b.rig.app->ui().widgets().find("description." + mark);
    REQUIRE(r != b.rig.app->ui().widgets().end());
    return r->second;
  };
  const float beside = place("position.x").width, height = place("position.x").y;
  CHECK(place("position.remove").y == doctest::Approx(height).epsilon(0.02));
  b.type_in("position.x", "-12.345678");
  CHECK(place("position.x").width > 1.5f * beside);
  CHECK(place("position.x").y > height + 10);  // under its name
  CHECK(place("position.remove").y > height + 10);
  CHECK(place("position.remove").x > place("position.z").x);
  b.go("bodies.ball.look");
  b.play("move description.label\nwait 40");
  CHECK(b.rig.app->ui().widgets().at("tooltip").height > 45);  // three lines: two of text, and help
  check_no_faults(*b.device);
}

TEST_CASE("description: items of a list are told by what sets them apart") {
  FaultList faults;
  const auto scene = parse_json(R"({ "bodies": { "ball": { "material": "steel", "shapes": [
    { "type": "sphere", "radius": 0.2, "material": "wood" },
    { "type": "sphere", "radius": 0.1, "material": "wood", "position": [0, 1, 0] },
    { "type": "box", "size": [1, 2, 3], "material": "wood" }] } } })",
                                "", faults);
  REQUIRE(scene);
  const auto told = [](const OutlineKey& key) {
    std::string out = key.summary;
    for (const ToldValue& one : key.told)
      out += "; " + one.key + " " + one.value + (one.unit.empty() ? "" : " " + one.unit);
    return out;
  };
  const ScenePath ball = ScenePath{} / "bodies" / "ball";
  const Outline shapes = outline_of(*scene, ball / "shapes");
  REQUIRE(shapes.keys.size() == 3);
  CHECK(told(shapes.keys[0]) == "sphere; radius 0.2 m");
  CHECK(told(shapes.keys[1]) == "sphere; radius 0.1 m; position 0, 1, 0 m");
  CHECK(told(shapes.keys[2]) == "box; size 1, 2, 3 m");
  // What stands alone says all that it can in few words, first what it is made of.
  const Outline bodies = outline_of(*scene, ScenePath{} / "bodies");
  CHECK(told(bodies.keys[0]) == "; shapes sphere, sphere, box; material steel");
}

TEST_CASE("description: how a body begins changes at once where the run has not begun") {
  Described b(with(two_bodies, "\"position\": [0, 2, 0]",
                   "\"position\": [0, 2, 0], \"velocity\": [0, 0, 0]"));
  const World* const before = &b.world();
  b.go("bodies.ball");
  b.type_in("position.y", "3");
  b.type_in("velocity.x", "1.5");
  CHECK(&b.world() == before);  // without being opened anew
  CHECK(place(b, "ball").y() == 3);
  const uint64_t now = b.hash();
  const std::string text = b.saved();
  // Numbers beside the one that was changed stay as they are written.
  CHECK(text == with(b.start, R"([0, 2, 0], "velocity": [0, 0, 0] })",
                     R"([0, 3.0, 0], "velocity": [1.5, 0, 0] })"));
  for (int i = 0; i < 2; ++i) b.play("key Ctrl+Z\nwait 4");
  CHECK(b.hash() == b.start_hash);
  CHECK(b.saved() == b.start);
  // Opened from the file, the world is the same.
  REQUIRE(write_file(b.file, std::string_view(text)).ok());
  b.rig.app->open(b.file);
  b.play("wait 3");
  CHECK(&b.world() != before);
  CHECK(b.hash() == now);
  check_no_faults(*b.device);
}

TEST_CASE("description: what takes its place from a body is placed anew with it") {
  Described b(two_bodies + R"(,
  "joints": { "pivot": { "kind": "spherical", "b": "ball", "anchor": [0, 3, 0] } })");
  b.go("bodies.ball");
  b.type_in("position.y", "2.5");
  const uint64_t now = b.hash();
  const std::string text = b.saved();
  REQUIRE(write_file(b.file, std::string_view(text)).ok());
  b.rig.app->open(b.file);
  b.play("wait 3");
  CHECK(b.hash() == now);
  check_no_faults(*b.device);
}

TEST_CASE("description: parts of robots are chosen by name, and so are joints of their files") {
  Described b(two_bodies + R"(,
  "robots": { "arm": { "file": "robots/arm.urdf", "position": [3, 0, 0] } })");
  REQUIRE_FALSE(b.world().find_body("arm_base").is_null());
  b.go("cameras.main");
  b.add("follow");
  b.choose("follow", "arm_base", ".names");
  CHECK_FALSE(b.faulty());
  CHECK(b.saved().find(R"("follow": "arm_base")") != std::string::npos);
  b.go("robots.arm");
  b.add("start_deg");
  b.play("click description.add\nwait 2");
  CHECK(b.rig.app->locate("description.add.pan").has_value());
  b.play("click description.add.elbow\nwait 4");
  CHECK_FALSE(b.faulty());
  CHECK(b.saved().find(R"("start_deg": { "elbow": )") != std::string::npos);
  // One that is there already is not offered again.
  b.go("robots.arm.start_deg");
  b.play("click description.add\nwait 2");
  CHECK_FALSE(b.rig.app->locate("description.add.elbow").has_value());
  CHECK(b.rig.app->locate("description.add.lift").has_value());
  check_no_faults(*b.device);
}

TEST_CASE(
    "description: a course, what is drawn and sleep act at once where the run has not begun") {
  Described b(R"x(  "bodies": {
    "ground": { "type": "static", "shape": { "type": "half_space" }, "material": "wood" },
    "cam": {
      "type": "kinematic", "shape": { "type": "sphere", "radius": 0.5 }, "position": [0, 2, 0],
      "course": { "x": "= 0.5*sin(2*t)" }, // to and fro
      "drawn": [{ "type": "box", "size": [1, 1, 1] }]
    },
    "ball": { "shape": { "type": "sphere", "radius": 0.5 }, "position": [3, 2, 0], "starts_asleep": false }
  },
  "cameras": { "main": { "position": [0, 2.5, 9], "target": [0, 1.5, 0] } })x");
  const World* const before = &b.world();
  const auto cam = [&] { return *b.world().body_def(b.world().find_body("cam")); };
  b.go("bodies.cam.course");
  b.type_in("x", "= 1 + 0.25*sin(3*t)");
  b.go("bodies.ball");
  b.play("click description.starts_asleep\nwait 4");
  CHECK(&b.world() == before);  // without being opened anew
  CHECK(place(b, "cam") == Vec3(1, 2, 0));
  CHECK(b.world().body(b.world().find_body("ball"))->asleep);
  const uint64_t now = b.hash();
  const std::string text = b.saved();
  CHECK(text == with(with(b.start, "= 0.5*sin(2*t)", "= 1 + 0.25*sin(3*t)"),
                     R"("starts_asleep": false)", R"("starts_asleep": true)"));
  for (int i = 0; i < 2; ++i) b.play("key Ctrl+Z\nwait 4");
  CHECK(b.hash() == b.start_hash);
  CHECK(b.saved() == b.start);
  for (int i = 0; i < 2; ++i) b.play("key Ctrl+Shift+Z\nwait 4");
  CHECK(b.hash() == now);
  // What is drawn changes at any time; a course is one from the start, so that the run is another.
  REQUIRE(b.rig.app->session().advance(30).ok());
  b.play("wait 3");
  const double there = 1 + 0.25 * std::sin(3 * 0.5);
  CHECK(place(b, "cam").x() == doctest::Approx(there).epsilon(1e-12));
  b.go("bodies.cam.drawn.0");
  b.type_in("size.y", "0.25");
  CHECK(&b.world() == before);
  REQUIRE(cam().drawn.size() == 1);
  CHECK(cam().drawn[0].shape.half_extents.y() == 0.125);
  CHECK(place(b, "cam").x() == doctest::Approx(there).epsilon(1e-12));
  CHECK(cam().course != nullptr);
  CHECK(b.saved() == with(text, "[1, 1, 1]", "[1, 0.25, 1]"));
  b.go("bodies.cam.course");
  b.type_in("x", "= sin(t)");
  CHECK(&b.world() != before);
  CHECK(b.rig.tick() == 30);
  CHECK(place(b, "cam").x() == doctest::Approx(std::sin(0.5)).epsilon(1e-12));
  // Opened from the file, the world of the first two changes is the same.
  REQUIRE(write_file(b.file, std::string_view(text)).ok());
  b.rig.app->open(b.file);
  b.play("wait 3");
  CHECK(b.hash() == now);
  check_no_faults(*b.device);
}

TEST_CASE("description: how a body begins is not changed where the run has begun meanwhile") {
  Described b(two_bodies);
  REQUIRE(b.rig.app->session().advance(1).ok());
  b.play("wait 2");
  const uint64_t now = b.hash();
  b.rig.app->ask(EditBody{b.world().find_body("ball"),
                          "Change position of ball",
                          [](BodyDef& d) { d.pose.x.y() = 5; },
                          {},
                          true});
  b.play("wait 3");
  CHECK(b.hash() == now);
  CHECK(says(b.rig, "the run has begun meanwhile"));
  check_no_faults(*b.device);
}

TEST_CASE("description: names of a robot's parts are those of the robot that is there now") {
  Described b(two_bodies + R"(,
  "robots": { "arm": { "file": "robots/arm.urdf", "position": [3, 0, 0] } })");
  std::string other = *read_file(std::string(TUMBLE_SOURCE_DIR) + "/scenes/robots/arm.urdf");
  for (size_t at = 0; (at = other.find("\"elbow\"", at)) != std::string::npos; at += 6)
    other.replace(at, 7, "\"knee\"");
  const auto file = b.rig.folder.path() / "other.urdf";
  REQUIRE(write_file(file, std::string_view(other)).ok());
  b.go("robots.arm");
  b.add("start_deg");
  b.save();
  // The text stays and the place that is looked at: only the choice beside the file is another.
  b.rig.app->open(OpenRequest{b.file, {"robots.arm.file=" + file.string()}, {}});
  b.play("wait 4\nclick description.add\nwait 2");
  CHECK(b.rig.app->locate("description.add.knee").has_value());
  CHECK_FALSE(b.rig.app->locate("description.add.elbow").has_value());
  check_no_faults(*b.device);
}
