// Robots in scenes, and as scenes. References: places and names written out by hand; the equation
// of a compound pendulum, integrated here.
#include "engine/scene/robot_scene.hpp"

#include "engine/scene/catalogue.hpp"
#include "engine/scene/check.hpp"
#include "engine/scene/writer.hpp"
#include "engine/world/world.hpp"
#include "tests/scene/robots/robot_text.hpp"

#include <numbers>

using namespace tumble;
using namespace tumble::test;

namespace {

/// A bar of 1 m and 3 kg on a hinge at its end, which hangs along -z at angle 0.
const std::string bar_urdf = R"(<robot name="bar">
  <link name="post"><collision><origin xyz="0 0 1"/><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
  <link name="bar"><inertial><origin xyz="0 0 -0.5"/><mass value="3"/>
    <inertia ixx="0.25" ixy="0" ixz="0" iyy="0.25" iyz="0" izz="0.01"/></inertial>
    <collision><origin xyz="0 0 -0.5"/><geometry><box size="0.1 0.1 1"/></geometry></collision></link>
  <joint name="hinge" type="continuous"><parent link="post"/><child link="bar"/>
    <origin xyz="0 0.2 1.5"/><axis xyz="0 1 0"/><limit effort="1000" velocity="10"/></joint>
</robot>)";

const BodyFrame& frame_of(const BuiltScene& s, std::string_view name) {
  return s.world->frame()->body(s.bodies.find(name)->second.index);
}
double angle_of(const BuiltScene& s, std::string_view joint) {
  for (const JointFrame& j : *s.world->frame()->joints)
    if (j.name == joint) return j.coordinate("angle")->value;
  FAIL("no joint");
  return 0;
}

}  // namespace

TEST_CASE("robots of a scene: prefix, place, start, overrides") {
  const ScratchFolder folder("robots_key");
  folder.write("bar.urdf", bar_urdf);
  const std::string text = scene_with(R"("parameters": {"x": 4}, "robots": {
    "left": {"file": "bar.urdf", "position": ["$x", 0, 0], "start_deg": {"hinge": 30}},
    "right": "bar.urdf"}, "cameras": {"main": {"follow": "left_bar"}})");
  const std::string file = (folder.path / "scene.json").string();
  const SceneRead read =
      read_scene(text, file,
                 {{"parameters.x=6", "bodies.right_bar.mass=5", "robots.right.position=[-3, 0, 0]",
                   "joints.left_hinge.motor.stiffness=7"}});
  const BuiltScene s = build_of(read);
  CHECK(s.bodies.size() == 4);
  CHECK(read.scene.robots.empty());
  CHECK((frame_of(s, "left_post").pose.x - Vec3(6, 0, 0)).norm() < 1e-12);
  CHECK((frame_of(s, "right_post").pose.x - Vec3(-3, 0, 0)).norm() < 1e-12);
  CHECK(s.world->body(s.bodies.find("right_bar")->second)->mass == 5);
  CHECK(angle_of(s, "left_hinge") == doctest::Approx(std::numbers::pi / 6));
  CHECK(angle_of(s, "right_hinge") == 0);
  CHECK(*read.scene.joints.find("left_hinge")->drive.motor->stiffness == 7);
  // Turned by 30 degrees about the file's y, Tumble's -z: -z goes towards -x.
  const Vec3 hinge(6, 1.5, -0.2);
  const Vec3 centre = hinge + 0.5 * Vec3(-0.5, -std::sqrt(0.75), 0);
  CHECK((frame_of(s, "left_bar").pose.x - centre).norm() < 1e-9);
  // What was taken in is written as what it is.
  const SceneRead again = read_scene(write_scene(read.scene), file);
  CHECK(again.ok());
  CHECK(again.scene.bodies.size() == 4);
}

TEST_CASE("robots of a scene: faults name the robot, its file and line") {
  const ScratchFolder folder("robots_faults");
  folder.write("bad.urdf", "<robot>\n<link/>\n</robot>");
  folder.write("bar.urdf", bar_urdf);
  const auto first = [&](const std::string& members) {
    const SceneRead read = read_scene(scene_with(members), (folder.path / "s.json").string());
    return read.ok() ? std::string("none") : all_text(read.faults);
  };
  const auto says = [&](const std::string& members, const std::string& part) {
    const std::string found = first(members);
    CHECK_MESSAGE(found.find(part) != std::string::npos, found, " should say ", part);
  };
  says(R"("robots": {"r": "bad.urdf"})", "s.json:2: robots.r: ");
  says(R"("robots": {"r": "bad.urdf"})", "bad.urdf:2: <link>: the attribute 'name' is missing");
  says(R"("robots": {"r": "gone.urdf"})", "there is no robot file");
  says(R"("robots": {"r": {"file": "bar.urdf", "base": "loose"}})", "robots.r.base");
  says(R"("robots": {"r": {"file": "bar.urdf", "start_deg": {"hing": 1}}})",
       "did you mean 'hinge'");
  says(
      R"("robots": {"r": {"file": "bar.urdf", "prefix": ""}}, "bodies": {"bar": {"shape": {"type": "sphere", "radius": 1}}})",
      "bodies.bar");
  says(R"("robots": {"r": {"file": "bar.urdf", "odd": 1}})", "robots.r.odd");
  SceneDescription by_code;
  by_code.robots.add("r").file = "bar.urdf";
  CHECK(all_text(validate(by_code)).find("robots.r") != std::string::npos);
}

TEST_CASE("a bare robot file is a scene: floor, camera, motors that hold it") {
  const ScratchFolder folder("robot_scene");
  const auto file = folder.write("bar.urdf", bar_urdf);
  const SceneRead read = open_scene(file.string(), {{"robots.robot.start_deg.hinge=60"}});
  BuiltScene s = build_of(read);
  CHECK(s.bodies.size() == 3);
  CHECK(s.bodies.contains("floor"));
  CHECK(frame_of(s, "post").pose.x.norm() < 1e-12);
  REQUIRE(read.scene.cameras.size() == 1);
  // A critically damped servo of 4 Hz gives way by torque over stiffness.
  for (int k = 0; k < 90; ++k) REQUIRE(s.world->step().ok());
  const double inertia = 0.25 + 3 * 0.25, rate = 8 * std::numbers::pi;
  double angle = std::numbers::pi / 3;
  for (int k = 0; k < 50; ++k)
    angle = std::numbers::pi / 3 - 3 * 9.81 * 0.5 * std::sin(angle) / (inertia * rate * rate);
  CHECK(angle_of(s, "hinge") == doctest::Approx(angle).epsilon(1e-3));

  const SceneCheck check = check_scene(file.string());
  CHECK(check.faults.empty());
  REQUIRE_FALSE(check.warnings.empty());
  CHECK(check.warnings[0].find("bar.urdf:7: <limit>: 'velocity'") != std::string::npos);
  const auto bad = folder.write("bad.urdf", "<robot>\n<link/>\n</robot>");
  CHECK(all_text(check_scene(bad.string()).faults).find("bad.urdf:2: ") != std::string::npos);
}

TEST_CASE("a finger follows its neighbour: mimic holds under both steppers, with the prefix") {
  const ScratchFolder folder("robot_mimic");
  const std::string ball = R"(<inertial><origin xyz="0.3 0 0"/><mass value="1"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01"/></inertial></link>)";
  folder.write("grip.urdf", R"(<robot name="grip"><link name="palm"/><link name="left">)" + ball +
                                R"(<link name="right">)" + ball + R"(
    <joint name="l" type="continuous"><parent link="palm"/><child link="left"/><axis xyz="0 0 1"/></joint>
    <joint name="r" type="continuous"><parent link="palm"/><child link="right"/><axis xyz="0 0 1"/>
      <mimic joint="l" multiplier="-0.5" offset="0.2"/></joint></robot>)");
  for (const char* stepper : {"realtime", "event"}) {
    const std::string text =
        scene_with(R"("settings": {"gravity": [0, 0, 1], "stepper": ")" + std::string(stepper) +
                   R"("}, "robots": {"hand": "grip.urdf"})");
    BuiltScene s = build_of(read_scene(text, (folder.path / "s.json").string()));
    CHECK(angle_of(s, "hand_r") == doctest::Approx(0.2));
    for (int k = 0; k < 60; ++k) REQUIRE(s.world->step().ok());
    CHECK(std::fabs(angle_of(s, "hand_l")) > 0.05);
    CHECK(angle_of(s, "hand_r") ==
          doctest::Approx(0.2 - 0.5 * angle_of(s, "hand_l")).epsilon(1e-5));
  }
}

TEST_CASE("a robot swings when nothing holds it, a base without mass cannot float") {
  const ScratchFolder folder("robot_swing");
  const auto file = folder.write("bar.urdf", bar_urdf);
  BuiltScene s = build_of(
      open_scene(file.string(), {{"robots.robot.start_deg.hinge=60", "robots.robot.motors=file"}}));
  // I q'' = -m g l sin q by Runge-Kutta of order 4.
  const double k = 3 * 9.81 * 0.5 / (0.25 + 3 * 0.25), h = 1.0 / 6000;
  double q = std::numbers::pi / 3, v = 0;
  for (int i = 0; i < 6000; ++i) {
    const double v1 = v, a1 = -k * std::sin(q);
    const double v2 = v + h / 2 * a1, a2 = -k * std::sin(q + h / 2 * v1);
    const double v3 = v + h / 2 * a2, a3 = -k * std::sin(q + h / 2 * v2);
    const double v4 = v + h * a3, a4 = -k * std::sin(q + h * v3);
    q += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  for (int i = 0; i < 60; ++i) REQUIRE(s.world->step().ok());
  CHECK(std::fabs(angle_of(s, "hinge") - q) < 0.02);

  const SceneRead loose = open_scene(file.string(), {{"robots.robot.base=floating"}});
  REQUIRE(loose.ok());  // the post has no mass and stays
  CHECK(loose.scene.bodies.find("post")->type == BodyType::fixed);
}

TEST_CASE("links that overlap at the start, and neighbours, do not collide, or none at all") {
  const std::string ball =
      R"(<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>
    <collision><geometry><sphere radius="0.3"/></geometry></collision></link>)";
  const std::string turn = R"(type="continuous"><origin xyz="0.25 0 0"/><axis xyz="0 0 1"/>)";
  std::string text;
  for (const char* name : {"a", "b", "c", "d"})
    text += fmt::format("<link name=\"{}\">{}", name, ball);
  for (const char* pair : {"ab", "bc", "cd"})
    text += fmt::format(R"(<joint name="{}" {}<parent link="{}"/><child link="{}"/></joint>)", pair,
                        turn, pair[0], pair[1]);
  ReadRobot r = urdf(text);
  RobotParts parts = make_robot(r.model, {}, r.log);
  // a-c and b-d are 0.5 m apart with radii of 0.3 m, a-d 0.75 m.
  size_t apart = 0;
  for (const auto& j : parts.scene.joints.items) apart += j.value.kind == JointKind::free;
  CHECK(apart == 2);
  CHECK(warns(r.log, "r.urdf:", "'c' overlaps 'a' at the start"));
  parts = make_robot(r.model, {.self_collision = false, .group = 9}, r.log);
  CHECK(parts.scene.joints.size() == 3);
  CHECK(parts.scene.bodies.find("c")->group == 9);
}

TEST_CASE("the shipped arm follows its targets") {
  BuiltScene s = build_of(load_scene(std::string(TUMBLE_SOURCE_DIR) + "/scenes/robot_arm.json"));
  const double start = angle_of(s, "arm_pan");
  CHECK(start == doctest::Approx(-100 * std::numbers::pi / 180));
  for (int k = 0; k < 240; ++k) REQUIRE(s.world->step().ok());
  CHECK(std::fabs(angle_of(s, "arm_pan") - 70 * std::numbers::pi / 180) < 0.1);
  CHECK(std::fabs(angle_of(s, "arm_lift") - 48 * std::numbers::pi / 180) < 0.1);
}
