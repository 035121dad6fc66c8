// Reading scenes. The reference is written by hand beside each text: the line (counted in the
// text), the path and a part of the message of every fault that must be found, and that no other
// is.
#include "engine/scene/writer.hpp"
#include "tests/scene/scene_text.hpp"

#include <cmath>
#include <vector>

using namespace tumble;

namespace {

struct Expected {
  int line;
  std::string path;
  std::string part;  ///< of the message
};

void check_faults(const std::string& text, const std::vector<Expected>& expected) {
  const SceneRead read = read_scene(text, "x.json");
  INFO(text << "\n-> " << all_text(read.faults));
  REQUIRE(read.faults.size() == expected.size());
  for (size_t i = 0; i < expected.size(); ++i) {
    CHECK(read.faults[i].file == "x.json");
    CHECK(read.faults[i].line == expected[i].line);
    CHECK(read.faults[i].path == expected[i].path);
    CHECK(read.faults[i].message.find(expected[i].part) != std::string::npos);
  }
}

/// One ball with more members, on line 3.
std::string ball(const std::string& members) {
  return scene_with("\"bodies\": {\n\"ball\": {\"shape\": {\"type\": \"sphere\", \"radius\": 1}, " +
                    members + "}}");
}

}  // namespace

TEST_CASE("a scene with every key is read without faults") {
  const SceneRead read = load_scene(data_file("everything.json"));
  INFO(all_text(read.faults));
  REQUIRE(read.ok());
  const SceneDescription& s = read.scene;
  CHECK(s.title == "Everything");
  CHECK(s.seed == 42);
  CHECK(s.parameters_.find("twice")->value == 6);
  CHECK(s.settings.tick == TickRate{120, 1});
  CHECK(s.settings.realtime.substeps == 5);
  CHECK(*s.materials.find("slick")->friction == 0.05);
  CHECK(s.meshes.find("plain")->file == "tetra.obj");
  CHECK(s.meshes.find("tetra")->up == UpAxis::z);
  REQUIRE(s.bodies.size() == 9);
  const BodyDescription& brick = *s.bodies.find("brick");
  CHECK(std::get<GridRepetition>(brick.repeat[0].kind).count == std::array{3, 2, 1});
  CHECK(brick.colours.size() == 3);
  CHECK(*brick.copies.find("1")->mass == 7);
  const BodyDescription& ball = *s.bodies.find("ball");
  CHECK(ball.velocity == Vec3(0, 1, -9));
  CHECK(ball.material->like == "slick");
  CHECK(std::get<SpringDescription>(s.forces.find("rope")->kind).b.point == Vec3(0, 8, -9));
  CHECK(s.particles.find("sand")->list[1].mass == 0.01);
  CHECK(s.cameras.items[1].value.follow == "ball");
  CHECK(s.look.exposure == 1.1);
}

TEST_CASE("files that are no scenes") {
  check_faults("", {{1, "", "the file is empty"}});
  check_faults(" \n\n", {{1, "", "the file is empty"}});
  check_faults("{", {{1, "", "unexpected end of input"}});
  check_faults("{\n\"tumble_scene\": 1", {{2, "", "unexpected end of input"}});
  check_faults("[1, 2]", {{1, "", "a scene is an object, got an array of 2"}});
  check_faults("\n{}", {{2, "", "'tumble_scene' is missing"}});
  check_faults("{\"tumble_scene\":\n2}", {{2, "tumble_scene", "must be 1, got 2"}});
  check_faults("{\"tumble_scene\": \"1\"}", {{1, "tumble_scene", "must be 1, got \"1\""}});
  check_faults("{\"tumble_scene\": 1}\n\n x", {{3, "", "expected end of input"}});
  check_faults("{\"tumble_scene\": 1,\n\"seed\": 1e999}", {{2, "", "overflow"}});
  check_faults("{\"tumble_scene\": 1,\n\"seed\": NaN}", {{2, "", "invalid literal"}});
  check_faults("{\"tumble_scene\": 1,\n\"title\": \"\xff\"}", {{2, "", "UTF-8"}});
}

TEST_CASE("a byte order mark and comments are allowed") {
  check_faults("\xEF\xBB\xBF{\"tumble_scene\": 1}", {});
  check_faults("// one\n/* two\n three */ {\"tumble_scene\": 1, // four\n\"sed\": 1}",
               {{4, "sed", "unknown key 'sed', did you mean 'seed'?"}});
}

TEST_CASE("every value has its line, also behind numbers at the end of a line") {
  check_faults(scene_with("\"seed\": -1\n,\n\"title\": 5\n"),
               {{2, "seed", "must be a whole number >= 0, got -1"},
                {4, "title", "must be a string, got 5"}});
}

TEST_CASE("all faults at once, in the order of the file") {
  check_faults(scene_with("\"titel\": \"x\",\n"
                          "\"bodies\": {\n"
                          "  \"a\": {\"shape\": {\"type\": \"sphere\", \"radius\": -1}},\n"
                          "  \"b\": {\"shape\": {\"type\": \"bx\"}},\n"
                          "  \"c\": {\"shape\": {\"type\": \"box\"}, \"postion\": [0, 0, 0]}\n"
                          "},\n\"lights\": 7"),
               {{2, "titel", "did you mean 'title'?"},
                {4, "bodies.a.shape.radius", "must be > 0 and <= 1000000 m, got -1 m"},
                {5, "bodies.b.shape.type", "unknown type 'bx', did you mean 'box'?"},
                {6, "bodies.c.shape", "the key 'size' is missing"},
                {6, "bodies.c.postion", "did you mean 'position'?"},
                {8, "lights", "must be an object, got 7"}});
}

TEST_CASE("wrong types and values out of range") {
  check_faults(ball("\"position\": [0, 1]"),
               {{3, "bodies.ball.position", "must be an array of 3 numbers, got an array of 2"}});
  check_faults(ball("\"position\": [0, \"up\", 1]"),
               {{3, "bodies.ball.position[1]", "must be a number, got \"up\""}});
  check_faults(ball("\"position\": [0, 1e8, 1]"),
               {{3, "bodies.ball.position[1]", "got 100000000 m"}});
  check_faults(ball("\"mass\": 0"), {{3, "bodies.ball.mass", "must be > 0"}});
  check_faults(ball("\"mass\": true"), {{3, "bodies.ball.mass", "must be a number, got true"}});
  check_faults(ball("\"mass\": 1, \"density\": 2"),
               {{3, "bodies.ball.mass", "give mass or density, not both"}});
  check_faults(ball("\"can_sleep\": 1"), {{3, "bodies.ball.can_sleep", "must be true or false"}});
  check_faults(ball("\"type\": \"fixed\""), {{3, "bodies.ball.type", "Known: static, kinematic"}});
  check_faults(ball("\"type\": \"static\", \"velocity\": [1, 0, 0]"),
               {{3, "bodies.ball.type", "static body cannot have a velocity"}});
  check_faults(ball("\"colour\": \"orenge\""),
               {{3, "bodies.ball.colour", "did you mean 'orange'?"}});
  check_faults(ball("\"colour\": \"#12345\""), {{3, "bodies.ball.colour", "#rrggbb"}});
  check_faults(ball("\"colour\": [0, 0, 2]"), {{3, "bodies.ball.colour[2]", "<= 1, got 2"}});
  check_faults(ball("\"orientation\": [0, 0, 0, 0]"), {{3, "bodies.ball.orientation", "zeros"}});
  check_faults(ball("\"axis\": [0, 1, 0]"), {{3, "bodies.ball.axis", "needs angle_deg"}});
  check_faults(ball("\"euler_deg\": [0, 0, 0], \"orientation\": [1, 0, 0, 0]"),
               {{3, "bodies.ball", "give one of orientation, euler_deg"}});
  check_faults(ball("\"shapes\": []"), {});
  check_faults(scene_with("\"bodies\": {\n\"b\": {}}"), {{3, "bodies.b", "needs a shape"}});
  check_faults(scene_with("\"bodies\": []"), {{2, "bodies", "maps names to values"}});
  check_faults(scene_with("\"settings\": {\"tick_hz\": 0}"), {{2, "settings.tick_hz", ">= 1 Hz"}});
  check_faults(scene_with("\"settings\": {\"tick_hz\": \"60/0\"}"),
               {{2, "settings.tick_hz", "n/d"}});
  check_faults(scene_with("\"settings\": {\"realtime\": {\"substeps\": 2.5}}"),
               {{2, "settings.realtime.substeps", "must be a whole number, got 2.5"}});
  check_faults(scene_with("\"settings\": {\n\"stepper\": \"realtme\"}"),
               {{3, "settings.stepper", "unknown stepper 'realtme', did you mean 'realtime'?"}});
  check_faults(scene_with("\"cameras\": {\"c\": {\"fov_deg\": 500}}"),
               {{2, "cameras.c.fov_deg", ">= 1 and <= 150 deg, got 500 deg"}});
}

TEST_CASE("names: repeated, malformed, missing") {
  check_faults(scene_with("\"seed\": 1,\n\"seed\": 2"), {{3, "", "'seed' is given twice"}});
  check_faults(scene_with("\"materials\": {\n\"a-b\": {}}"),
               {{3, "materials.a-b", "is not a name"}});
  check_faults(ball("\"material\": \"wod\""),
               {{3, "bodies.ball.material", "unknown material 'wod', did you mean 'wood'?"}});
  check_faults(scene_with("\"materials\": {\n\"a\": {\"like\": \"b\"},\n\"b\": {\"like\": \"a\"}}"),
               {{3, "materials.a.like", "in a circle"}, {4, "materials.b.like", "in a circle"}});
  check_faults(
      scene_with("\"bodies\": {\n\"b\": {\"shape\": {\"type\": \"mesh\", \"mesh\": \"x\"}}}"),
      {{3, "bodies.b.shape.mesh", "unknown mesh 'x'"}});
  check_faults(scene_with("\"cameras\": {\n\"c\": {\"follow\": \"nobody\"}}"),
               {{3, "cameras.c.follow", "unknown body 'nobody'"}});
  check_faults(scene_with("\"forces\": {\n\"f\": {\"type\": \"spring\",\n\"a\": {\"body\": "
                          "\"x\"},\n\"b\": {\"particles\": \"y\"}}}"),
               {{4, "forces.f.a.body", "unknown body 'x'"},
                {5, "forces.f.b.particles", "unknown particle system 'y'"}});
  check_faults(scene_with("\"forces\": {\n\"f\": {\"type\": \"spring\", \"a\": {}}}"),
               {{3, "forces.f", "the key 'b' is missing"}});
  check_faults(scene_with("\"forces\": {\n\"f\": {\"type\": \"load\", \"anchor\": {}, \"force\": "
                          "[1, 0, 0]}}"),
               {{3, "forces.f", "must be on a body or a particle"}});
}

TEST_CASE("a microscope names an algorithm, and bodies that there are") {
  const std::string bodies =
      "\"bodies\": {\"a\": {\"shape\": {\"type\": \"sphere\", \"radius\": 1}},\n\"b\": {\"shape\": "
      "{\"type\": "
      "\"sphere\", \"radius\": 1}}},\n";
  const auto microscope = [&](const std::string& members) {
    return scene_with(bodies + "\"microscope\": {" + members + "}");
  };
  check_faults(microscope("\"algorithm\": \"gjk\", \"a\": \"a\", \"b\": \"b\""), {});
  check_faults(microscope("\"algorithm\": \"dfsph\""), {});
  check_faults(microscope("\"algorithm\": \"vclip\", \"a\": \"a\", \"b\": \"b\""),
               {{4, "microscope.algorithm", "did you mean 'v_clip'?"}});
  check_faults(microscope("\"algorithm\": \"gjk\", \"a\": \"a\", \"b\": \"nobody\""),
               {{4, "microscope.b", "unknown body 'nobody'"}});
  check_faults(microscope("\"algorithm\": \"gjk\", \"a\": \"a\", \"b\": \"b\", \"span\": 0"),
               {{4, "microscope.span", "must be > 0 and"}});
}

TEST_CASE("a material may refine the built-in one of its name") {
  check_faults(scene_with("\"materials\": {\"steel\": {\"like\": \"steel\", \"friction\": 0.1}}"),
               {});
}

TEST_CASE("repetition: absurd counts, copies that do not exist") {
  const auto repeat = [](const std::string& r) { return ball("\n\"repeat\": " + r); };
  check_faults(repeat("{\"type\": \"stack\", \"count\": 1000000000, \"step\": [0, 1, 0]}"),
               {{4, "bodies.ball.repeat[0].count", "<= 200000, got 1000000000"}});
  check_faults(repeat("{\"type\": \"stack\", \"count\": 1e300, \"step\": [0, 1, 0]}"),
               {{4, "bodies.ball.repeat[0].count", "at most 2147483647"}});
  check_faults(
      repeat("{\"type\": \"grid\", \"count\": [9999, 9999, 9999], \"spacing\": [1, 1, 1]}"),
      {{4, "bodies.ball.repeat", "makes 9.997e+11 copies; at most 200000"}});
  check_faults(
      repeat("[{\"type\": \"ring\", \"count\": 1000, \"radius\": 1},\n{\"type\": \"ring\", "
             "\"count\": 1000, \"radius\": 1}]"),
      {{4, "bodies.ball.repeat", "at most 200000"}});
  check_faults(ball("\"copies\": {\"0\": {}}"),
               {
                   {3, "bodies.ball.copies", "only a body with repeat"},
               });
  check_faults(repeat("{\"type\": \"points\", \"points\": [[0, 0, 0]]}, \"copies\": {\n\"1\": {}}"),
               {{5, "bodies.ball.copies.1", "there is no copy 1: the copies are 0 to 0"}});
  check_faults(repeat("{\"type\": \"points\", \"points\": [[0, 0, 0]]}, \"copies\": {\n\"x\": {}}"),
               {{5, "bodies.ball.copies.x", "not the number of a copy"}});
  check_faults(
      repeat("{\"type\": \"formula\", \"count\": 2, \"position\": [\"i +\", \"0\", \"0\"]}"),
      {{4, "bodies.ball.repeat[0].position[0]", "expected a value, found the end"}});
  check_faults(repeat("{\"type\": \"formula\", \"count\": 2, \"position\": [\"i\"]}"),
               {{4, "bodies.ball.repeat[0].position", "needs 3 expressions, got 1"}});
}

TEST_CASE("gravity may follow time, by expressions and tables, and is written as it was read") {
  std::string text =
      scene_with(R"~("settings": {"gravity": [0, "= -9.81*cos(t)", [[0, 0], [2, 3]]]})~");
  for (int i = 0; i < 2; ++i) {
    const SceneRead read = read_scene(text, "x.json");
    INFO(all_text(read.faults));
    REQUIRE(read.ok());
    VaryingVec3 gravity = read.scene.settings.gravity;
    CHECK(gravity.now() == Vec3(0, -9.81, 0));
    CHECK_FALSE(gravity.of[0].varies());
    gravity.go_to(1);
    CHECK(gravity.now().y() == doctest::Approx(-9.81 * std::cos(1.0)).epsilon(1e-12));
    CHECK(gravity.now().z() == doctest::Approx(1.5));
    text = write_scene(read.scene);
  }
  check_faults(
      scene_with("\"settings\": {\n\"gravity\": [0, \"= 1 + \", [[1, 0], [1, 2]]]}"),
      {{3, "settings.gravity[1]", "expected a value"}, {3, "settings.gravity[2]", "ascend"}});
}

TEST_CASE("parameters: unknown, without a finite value, not whole") {
  check_faults(scene_with("\"parameters\": {\"mass\": 2},\n\"seed\": \"$mas\""),
               {{3, "seed", "unknown parameter 'mas', did you mean 'mass'?"}});
  check_faults(ball("\"mass\": \"= 1 + t\""),
               {{3, "bodies.ball.mass", "does not change with time"}});
  check_faults(ball("\"mass\": \"= 1 / 0\""), {{3, "bodies.ball.mass", "no finite value"}});
  check_faults(ball("\"mass\": \"= 1 +\""), {{3, "bodies.ball.mass", "expected a value"}});
  check_faults(scene_with("\"parameters\": {\"a\": {\"value\": 2, \"max\": 1}}"),
               {{2, "parameters.a.value", "outside its own min and max"}});
  check_faults(scene_with("\"parameters\": {\"h\": 0.5},\n\"settings\": {\"tick_hz\": \"$h\"}"),
               {{3, "settings.tick_hz", "must be a whole number"}});
}

TEST_CASE("nesting and size have limits") {
  const std::string deep(200, '[');
  check_faults("{\"tumble_scene\": 1, \"x\": " + deep, {{1, "", "nested deeper than 48"}});
  SceneRead read = read_scene(std::string((size_t{16} << 20) + 1, ' '), "x.json");
  REQUIRE(read.faults.size() == 1);
  CHECK(read.faults[0].message.find("at most 16777216 are read") != std::string::npos);
}

TEST_CASE("a file that is not there, and a folder") {
  CHECK(load_scene("/no/such/file.json").faults.at(0).text() ==
        "/no/such/file.json: there is no such file");
  CHECK(load_scene(TUMBLE_SOURCE_DIR).faults.at(0).message ==
        "this is a folder, a device or a pipe, not a file");
}
