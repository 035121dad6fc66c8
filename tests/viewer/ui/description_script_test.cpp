// All that the scene's file says, changed in the window by pointer and keys. Reference: the file as
// it would be written by hand, byte for byte; states of the world before and after.
#include "engine/scene/build.hpp"
#include "engine/scene/outline/outline.hpp"
#include "tests/viewer/ui/laboratory.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <future>
#include <thread>
#include <utility>

using namespace tumble;
using namespace tumble::test;

namespace {

/// A laboratory with a file of these bodies and what else is said.
struct Described : Laboratory {
  explicit Described(const std::string& members) {
    start = "{\n  \"tumble_scene\": 1, // mine\n" + members + "\n}\n";
    REQUIRE(write_file(file, std::string_view(start)).ok());
    rig.app->open(file);
    play("key B\nwait 3");  // nothing is to be built
    REQUIRE(rig.tick() == 0);
    rig.app->session().set_paused(true);
    start_hash = hash();
    play("key Shift+I\nwait 3");
  }
  void go(const std::string& place) {
    play("click description.way.0\nwait 2");
    std::string rest = place;
    while (!rest.empty()) {
      const size_t dot = rest.find('.');
      play("click description." + rest.substr(0, dot) + "\nwait 2");
      rest = dot == std::string::npos ? std::string() : rest.substr(dot + 1);
    }
  }
  void type_in(const std::string& key, const std::string& value) {
    play("click description." + key + "\nwait 2\nkey Ctrl+A\ntext " + value +
         "\nkey Enter\nwait 4");
  }
  /// Chooses a key from the list of absent ones, which is longer than its window: the wheel turns
  /// over whichever of its entries is seen.
  void add(const std::string& key) {
    play("click description.add\nwait 2");
    const auto seen = [&](const std::string& name) {
      return rig.app->locate("description.add." + name).has_value();
    };
    for (int n = 0; n < 20 && !seen(key); ++n)
      for (const char* over : {"title", "settings", "joints", "forces", "emitters", "sensors",
                               "lights", "type", "axis", "euler_deg", "drawn", "angular_velocity",
                               "mass", "centre", "colour", "gravity_scale", "precise", "colours"})
        if (seen(over)) {
          play("move description.add." + std::string(over) + "\nwait 1\nwheel -2\nwait 2");
          break;
        }
    play("click description.add." + key + "\nwait 4");
  }
  void choose(const std::string& key, const std::string& value, const char* list = "") {
    play("click description." + key + list + "\nwait 2\nclick description." + key + "." + value +
         "\nwait 4");
  }
  /// The file would be this now.
  std::string saved() {
    save();
    return content();
  }
  bool faulty() const { return rig.app->locate("description.faults").has_value(); }
};

const std::string two_bodies = R"(  "bodies": {
    "ground": { "type": "static", "shape": { "type": "half_space" }, "material": "wood" },
    "ball": { "shape": { "type": "sphere", "radius": 0.5 }, "position": [0, 2, 0] } // round
  },
  "cameras": { "main": { "position": [0, 2.5, 9], "target": [0, 1.5, 0] } })";

std::string with(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

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

namespace {

/// The two bodies with a session of its own thread that is busy until it is let go.
struct Busy {
  std::unique_ptr<Device> device = make_null_device();
  Rig rig{*device, "first", true};
  std::string file = (rig.folder.path() / "mine.json").string();
  std::string start = "{\n  \"tumble_scene\": 1,\n" + two_bodies + "\n}\n";
  std::promise<void> let_go;
  bool busy = true;

  Busy() {
    REQUIRE(write_file(file, std::string_view(start)).ok());
    rig.app->open(file);
    wait_for([&] { return rig.app->scene_name() != "first" && rig.tick() > 0; });
    rig.app->session().post([until = let_go.get_future().share()](World&) { until.wait(); });
  }
  ~Busy() { end(); }
  void end() {
    if (std::exchange(busy, false)) let_go.set_value();
  }
  template <class Holds>
  void wait_for(const Holds& holds) {
    for (int i = 0; i < 2000 && !holds(); ++i) {
      rig.frame();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    REQUIRE(holds());
  }
  void set_radius(const char* value) {
    rig.app->ask(EditDescription{ScenePath{} / "bodies" / "ball" / "shape" / "radius",
                                 EditDescription::How::set, value});
  }
  /// What is kept of unsaved work; "": nothing.
  std::string kept() const {
    if (!std::filesystem::exists(rig.unsaved())) return {};
    for (const auto& one : std::filesystem::directory_iterator(rig.unsaved()))
      if (one.path().extension() == ".json") return *read_file(one.path());
    return {};
  }
};

}  // namespace

TEST_CASE("description: no picture waits for a slow tick after a change, which is kept at once") {
  Busy b;
  const auto begun = std::chrono::steady_clock::now();
  b.set_radius("0.25");
  b.set_radius("0.125");
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begun;
  CHECK(taken.count() < 0.4);  // it waited for half a second for each
  const std::string changed = with(b.start, "0.5 }", "0.125 }");
  CHECK(b.kept() == changed);
  // Who quits now is told that it is kept, and it is.
  b.rig.play("key Ctrl+Q\nwait 3");
  CHECK(b.rig.app->locate("question.quit").has_value());
  b.rig.play("click question.quit\nwait 2");
  CHECK(b.rig.app->quit_requested());
  CHECK(b.kept() == changed);
  // Set back by hand there is nothing to keep, before the session has answered and after.
  b.set_radius("0.5");
  CHECK(b.kept().empty());
  b.end();
  for (int i = 0; i < 40; ++i) {
    b.rig.frame();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  CHECK(b.kept().empty());
  check_no_faults(*b.device);
}

TEST_CASE("description: a change that is taken back before the session has answered is not kept") {
  Busy b;
  b.set_radius("0.25");
  REQUIRE_FALSE(b.kept().empty());
  b.rig.play("key Ctrl+Z\nwait 2");
  b.end();
  b.wait_for([&] { return b.kept().empty(); });
  check_no_faults(*b.device);
}

TEST_CASE("description: what is changed in a slow tick is done to a file that others change then") {
  Busy b;
  b.set_radius("0.25");
  const std::string others = with(b.start, "\"wood\"", "\"steel\"");
  REQUIRE(write_file(b.file, std::string_view(others)).ok());
  for (int i = 0; i < 60; ++i) b.rig.frame();  // its file is looked at four times a second
  b.end();
  b.wait_for([&] { return b.kept() == with(others, "0.5 }", "0.25 }"); });
  check_no_faults(*b.device);
}

TEST_CASE("description: what was saved is a part of the text that is changed next") {
  Described b(two_bodies);
  b.rig.app->ask(
      EditBody{b.world().find_body("ball"), "Change mass of ball", [](BodyDef& d) { d.mass = 3; }});
  b.play("wait 70");
  const std::string saved = b.saved();
  REQUIRE(saved.find("\"mass\": 3") != std::string::npos);
  b.go("cameras.main");
  b.type_in("position.x", "1");
  b.play("wait 4");
  CHECK(*b.world().body_def(b.world().find_body("ball"))->mass == 3);
  CHECK(b.saved() == with(saved, "[0, 2.5, 9]", "[1, 2.5, 9]"));
  check_no_faults(*b.device);
}

namespace {

const std::string cam_and_ball = R"x(  "bodies": {
    "ground": { "type": "static", "shape": { "type": "half_space" }, "material": "wood" },
    "cam": {
      "type": "kinematic", "shape": { "type": "sphere", "radius": 0.5 }, "position": [0, 2, 0],
      "course": { "x": "= 1 + 0.5*sin(2*t)", "angle_deg": "= 170*t" }
    },
    "ball": { "shape": { "type": "sphere", "radius": 0.5 }, "position": [3, 2, 0], "starts_asleep": true }
  },
  "cameras": { "main": { "position": [0, 2.5, 9], "target": [0, 1.5, 0] } })x";

BodyDef def_of(Laboratory& b, const char* name) {
  return *b.world().body_def(b.world().find_body(name));
}
void displace(Laboratory& b, const char* name, const Vec3& shift) {
  b.rig.app->ask(SelectBody{b.world().find_body(name)});
  b.play("wait 3");
  Displacement way;
  way.shift = shift;
  b.rig.app->ask(DisplaceSelected{way});
  b.play("wait 3");
}
/// Saved and opened again, the world is the same, and after half a second too.
void check_opens_alike(Described& b) {
  const uint64_t now = b.hash();
  (void)b.saved();
  REQUIRE(b.rig.app->session().advance(30).ok());
  const uint64_t later = b.hash();
  b.rig.app->open(b.file);
  b.play("wait 3");
  REQUIRE(b.rig.tick() == 0);
  CHECK(b.hash() == now);
  REQUIRE(b.rig.app->session().advance(30).ok());
  CHECK(b.hash() == later);
}

}  // namespace

TEST_CASE("a body that is moved before the first tick takes its course along, and goes on asleep") {
  Described b(cam_and_ball);
  displace(b, "cam", {0, 1, 0});
  CHECK((place(b, "cam") - Vec3(1, 3, 0)).norm() < 1e-12);
  CHECK(def_of(b, "cam").course != nullptr);
  displace(b, "ball", {0, 1, 0});
  CHECK(b.world().body(b.world().find_body("ball"))->asleep);
  // Its place is typed as it is shown.
  b.rig.app->ask(EditBody{b.world().find_body("cam"), "Change position of cam",
                          [](BodyDef& d) { d.pose.x.x() = 2; }});
  b.play("wait 3");
  CHECK((place(b, "cam") - Vec3(2, 3, 0)).norm() < 1e-12);
  check_opens_alike(b);
  check_no_faults(*b.device);
}

TEST_CASE("a body that is moved later leaves its course from where it stands, in the file too") {
  for (const bool typed : {false, true}) {
    INFO(typed);
    Described b(cam_and_ball);
    REQUIRE(b.rig.app->session().advance(30).ok());
    b.play("wait 3");
    const Pose then = b.world().body(b.world().find_body("cam"))->body_frame();
    if (typed)
      b.rig.app->ask(EditBody{b.world().find_body("cam"), "Change position of cam",
                              [y = then.x.y()](BodyDef& d) { d.pose.x.y() = y + 0.1; }});
    else
      displace(b, "cam", {0, 0.1, 0});
    b.play("wait 3");
    const Pose now = b.world().body(b.world().find_body("cam"))->body_frame();
    CHECK((now.x - then.x - Vec3(0, 0.1, 0)).norm() < 1e-12);
    CHECK(now.q.angularDistance(then.q) < 1e-7);
    CHECK(def_of(b, "cam").course == nullptr);
    CHECK(b.saved().find("course") == std::string::npos);
    b.play("key Ctrl+Z\nwait 4");
    CHECK(def_of(b, "cam").course != nullptr);
    CHECK(b.saved() == b.start);
    check_no_faults(*b.device);
  }
}

TEST_CASE("description: what a gesture ends with is what the file says, in one undo step") {
  Described b(cam_and_ball);
  const ScenePath x = ScenePath{} / "bodies" / "cam" / "course" / "x";
  b.play("move 1300,1300\npress left\nwait 1");
  for (const char* value : {"\"= 1 + 0.25*sin(2*t)\"", "\"= 1 + 0.125*sin(2*t)\""}) {
    b.rig.app->ask(EditDescription{x, EditDescription::How::set, value});
    b.play("wait 2");
  }
  b.play("release left\nwait 3");
  CHECK(b.saved() == with(b.start, "0.5*sin", "0.125*sin"));
  b.play("key Ctrl+Z\nwait 4");
  CHECK(b.hash() == b.start_hash);
  check_no_faults(*b.device);
}

TEST_CASE("description: sleep is changed by a new start where a force may wake the body") {
  Described b(with(cam_and_ball, "\"starts_asleep\": true", "\"starts_asleep\": false") + R"(,
  "forces": { "air": { "type": "quadratic_drag", "wind": [1, 0, 0] } })");
  b.go("bodies.ball");
  b.play("click description.starts_asleep\nwait 4");
  CHECK_FALSE(b.world().body(b.world().find_body("ball"))->asleep);
  check_opens_alike(b);
  check_no_faults(*b.device);
}
