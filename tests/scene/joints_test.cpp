// Joints in scene files. References: frames written out by hand, the initial distance of anchors,
// and the list of faults that each wrong file has.
#include "engine/scene/build.hpp"
#include "engine/scene/writer.hpp"
#include "tests/scene/scene_text.hpp"

#include <doctest/doctest.h>

using namespace tumble;

namespace {

const std::string two_balls = R"("bodies": {"a": {"shape": {"type": "sphere", "radius": 0.1},
    "position": [1, 2, 3], "euler_deg": [0, 0, 90]},
  "b": {"shape": {"type": "sphere", "radius": 0.1}, "position": [1, 4, 3]},
  "link": {"shape": {"type": "sphere", "radius": 0.1}, "position": [0, 9, 0],
    "repeat": {"type": "stack", "count": 4, "step": [0, -0.5, 0]}}},)";

BuiltScene with_joints(const std::string& joints) {
  const SceneRead read =
      read_scene(scene_with(two_balls + "\"joints\": {" + joints + "}"), "x.json");
  INFO(all_text(read.faults));
  REQUIRE(read.ok());
  std::vector<Fault> faults;
  auto made = build_world(read.scene, {}, nullptr, &faults);
  INFO(all_text(faults));
  REQUIRE(made.ok());
  return std::move(*made);
}

std::vector<Fault> faults_of(const std::string& joints) {
  const SceneRead read =
      read_scene(scene_with(two_balls + "\"joints\": {\n" + joints + "}"), "x.json");
  if (!read.ok()) return read.faults;
  std::vector<Fault> faults;
  CHECK_FALSE(build_world(read.scene, {}, nullptr, &faults).ok());
  return faults;
}

const JointDef& joint(const BuiltScene& s, std::string_view name) {
  const auto it = s.joints.find(name);
  REQUIRE(it != s.joints.end());
  return *s.world->joint(it->second);
}

}  // namespace

TEST_CASE("anchor and axis are in the frame of a, or in the world") {
  const BuiltScene s = with_joints(R"(
    "own": {"kind": "revolute", "a": "a", "b": "b", "anchor": [1, 0, 0], "axis": [0, 2, 0], "collide": true},
    "world": {"kind": "prismatic", "b": "b", "anchor": [1, 5, 3], "axis": [1, 0, 0]})");
  // A's x axis points up: the anchor is at (1, 3, 3), 1 m below B, and its y axis to -x.
  const JointDef& own = joint(s, "own");
  CHECK((own.frame_b.x - Vec3(0, -1, 0)).norm() < 1e-12);
  CHECK((own.frame_a.direction(Vec3::UnitZ()) - Vec3::UnitY()).norm() < 1e-12);
  CHECK((own.frame_b.direction(Vec3::UnitZ()) + Vec3::UnitX()).norm() < 1e-12);
  CHECK(own.collide);
  const JointDef& world = joint(s, "world");
  CHECK(world.a.is_null());
  CHECK((world.frame_b.x - Vec3(0, 1, 0)).norm() < 1e-12);
  CHECK_FALSE(world.collide);
}

TEST_CASE("a universal joint has its second axis on b, a distance joint its length") {
  const BuiltScene s = with_joints(R"(
    "cross": {"kind": "universal", "b": "a", "axis": [0, 0, 1], "axis_b": [0, 1, 0]},
    "rod": {"kind": "distance", "a": "a", "b": "b", "anchor_b": [0, 1, 0]},
    "string": {"kind": "distance", "a": "a", "b": "b", "length": 0.25})");
  const JointDef& cross = joint(s, "cross");
  CHECK((cross.frame_a.direction(Vec3::UnitX()) - Vec3::UnitY()).norm() < 1e-12);
  CHECK((cross.frame_b.direction(Vec3::UnitX()) - Vec3::UnitX()).norm() < 1e-12);
  CHECK(joint(s, "rod").length == doctest::Approx(3).epsilon(1e-12));
  CHECK(joint(s, "string").length == 0.25);
}

TEST_CASE("one entry with a count ties a chain of copies") {
  BuiltScene s = with_joints(R"(
    "chain": {"kind": "spherical", "a": "link[i]", "b": "link[i+1]", "anchor": [0, -0.25, 0], "count": 3})");
  CHECK(s.joints.size() == 3);
  CHECK(joint(s, "chain[2]").b == s.bodies.find("link[3]")->second);
  CHECK((joint(s, "chain[1]").frame_b.x - Vec3(0, 0.25, 0)).norm() < 1e-12);
  for (int i = 0; i < 10; ++i) REQUIRE(s.world->step().ok());
}

TEST_CASE("faults of joints have their places") {
  const auto first = [](const std::string& joints, const char* path, const char* words) {
    const auto faults = faults_of(joints);
    INFO(all_text(faults));
    REQUIRE(faults.size() == 1);
    CHECK(faults[0].path == path);
    CHECK(faults[0].line == 7);
    CHECK(faults[0].message.find(words) != std::string::npos);
  };
  first("\"j\": {\"kind\": \"revolute\", \"b\": \"nobody\"}", "joints.j.b", "unknown body");
  first("\"j\": {\"kind\": \"revolute\", \"a\": \"b\", \"b\": \"b\"}", "joints.j.b", "same body");
  first("\"j\": {\"kind\": \"revolute\", \"b\": \"b\", \"axis\": [0, 0, 0]}", "joints.j.axis",
        "no direction");
  first("\"j\": {\"kind\": \"revolute\", \"b\": \"b\", \"length\": 2}", "joints.j.length",
        "only a distance joint");
  first("\"j\": {\"kind\": \"hinge\", \"b\": \"b\"}", "joints.j.kind", "revolute");
  first("\"j\": {\"kind\": \"universal\", \"b\": \"b\", \"axis_b\": [0, 1, 1]}", "joints.j.axis_b",
        "right angles");
  first("\"j\": {\"kind\": \"rigid\", \"a\": \"link[i]\", \"b\": \"link[i+1]\", \"count\": 4}",
        "joints.j.b", "no copy 4");
  first("\"j\": {\"kind\": \"rigid\", \"a\": \"link\", \"b\": \"b\"}", "joints.j.a", "say which");
}
