// --set: what is read afterwards, against the value set; faults name the path and "--set".
#include "tests/scene/scene_text.hpp"

using namespace tumble;

namespace {

SceneRead with(const std::string& assignment) {
  return read_scene(file_text(data_file("everything.json")), data_file("everything.json"),
                    {{assignment}});
}

SceneDescription good(const std::string& assignment) {
  SceneRead read = with(assignment);
  INFO(assignment << "\n" << all_text(read.faults));
  REQUIRE(read.ok());
  return read.scene;
}

std::string bad(const std::string& assignment) {
  const SceneRead read = with(assignment);
  INFO(assignment);
  REQUIRE_FALSE(read.faults.empty());
  CHECK(read.faults[0].file == "--set");
  CHECK(read.faults[0].line == 0);
  return read.faults[0].path + ": " + read.faults[0].message;
}

bool contains(const std::string& text, std::string_view part) {
  INFO(text);
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("values of every kind") {
  CHECK(*good("bodies.ball.mass=3").bodies.find("ball")->mass == 3);
  CHECK(good("seed=7").seed == 7);
  CHECK(good("title=A b").title == "A b");
  CHECK(good("settings.gravity=[0,-1.6,0]").settings.gravity.now() == Vec3(0, -1.6, 0));
  CHECK(good("settings.gravity.y=-3").settings.gravity.now() == Vec3(0, -3, 0));
  CHECK(good("settings.gravity[1]=-3").settings.gravity.now() == Vec3(0, -3, 0));
  CHECK(good("settings.realtime.max_substeps=9").settings.realtime.max_substeps == 9);
  CHECK(good("settings.tick_hz=50/3").settings.tick == TickRate{50, 3});
  CHECK(good("bodies.ball.can_sleep=true").bodies.find("ball")->can_sleep);
  CHECK(good("look.ground.visible=false").look.ground.visible == false);
  CHECK(good("cameras.main.fov_deg=20").cameras.find("main")->fov_deg == 20);
}

TEST_CASE("parameters change what uses them, and keep their limits") {
  const SceneDescription s = good("parameters.n=5");
  CHECK(s.parameters_.find("twice")->value == 10);
  CHECK(std::get<GridRepetition>(s.bodies.find("brick")->repeat[0].kind).count[0] == 5);
  CHECK(*good("parameters.mu=0.2").materials.find("slick")->friction == doctest::Approx(0.02));
  CHECK(*good("parameters.mu=0.2").parameters_.find("mu")->max == 1);
  CHECK(contains(bad("parameters.mu=2"), "parameters.mu.value: outside its own min and max"));
}

TEST_CASE("single copies") {
  const SceneDescription s = good("bodies.brick[3].mass=9");
  CHECK(*s.bodies.find("brick")->copies.find("3")->mass == 9);
  CHECK(*s.bodies.find("brick")->copies.find("1")->mass == 7);
  CHECK(*good("bodies.brick[1].mass=9").bodies.find("brick")->copies.find("1")->mass == 9);
  CHECK(contains(bad("bodies.brick[77].mass=9"), "there is no copy 77: the copies are 0 to 5"));
  CHECK(contains(bad("bodies.ball[0].mass=9"), "only a body with repeat has copies"));
}

TEST_CASE("through a shorthand") {
  CHECK(*good("bodies.ball.material.friction=0.3").bodies.find("ball")->material->friction == 0.3);
  CHECK(good("bodies.ball.material.friction=0.3").bodies.find("ball")->material->like == "slick");
  CHECK(good("meshes.plain.scale=2").meshes.find("plain")->scale == 2);
  CHECK(good("meshes.plain.scale=2").meshes.find("plain")->file == "tetra.obj");
  CHECK(good("materials.wood.friction=1").materials.find("wood")->like == "wood");
  CHECK(good("bodies.brick.repeat[0].count=[3,3,1]").bodies.find("brick")->repeat.size() == 1);
}

TEST_CASE("faults") {
  CHECK(contains(bad("bodies.bal.mass=3"),
                 "bodies.bal.mass: unknown name 'bal', did you mean 'ball'?"));
  CHECK(contains(bad("bodies.ball.mas=3"),
                 "bodies.ball.mas: unknown key 'mas', did you mean 'mass'?"));
  CHECK(contains(bad("bodies.ball.mass=-3"), "bodies.ball.mass: must be > 0"));
  CHECK(contains(bad("bodies.ball.mass=heavy"), "must be a number, got \"heavy\""));
  CHECK(contains(bad("bodies.ball.mass"), "not of the form path=value"));
  CHECK(contains(bad("=3"), "not of the form path=value"));
  CHECK(contains(bad("bodies..mass=3"), "not of the form path=value"));
  CHECK(contains(bad("bodies.ball.position[7]=3"), "index 7 of an array of 3"));
  CHECK(contains(bad("title.x=3"), "is not a part of"));
  CHECK(contains(bad("parameters.m=3"), "unknown name 'm'"));
  CHECK(contains(bad("tumble_scene=2"), ""));
}
