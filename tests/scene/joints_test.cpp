// Joints in scene files. References: frames written out by hand, the initial distance of anchors,
// and the list of faults that each wrong file has.
#include "engine/math/time_course.hpp"
#include "engine/scene/build.hpp"
#include "engine/scene/build/joint_rank.hpp"
#include "engine/scene/writer.hpp"
#include "engine/world/world.hpp"
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

TEST_CASE("what acts along coordinates: units, and the one of a joint stands without its name") {
  const BuiltScene s = with_joints(R"(
    "hinge": {"kind": "revolute", "b": "b", "limits": {"lower_deg": -90, "upper_deg": 45, "restitution": 0.5},
      "motor": {"position_deg": 30, "stiffness": 7, "damping": 2, "max_force": 5}, "break_torque": 9},
    "sleeve": {"kind": "cylindrical", "b": "a", "position": {"spring": {"stiffness": 3, "rest": 0.25}, "friction": 2},
      "angle": {"motor": {"velocity": 4}, "armature": 0.5}},
    "rope": {"kind": "free", "a": "a", "b": "link[0]", "limits": {"upper": 2}})");
  const double right = std::acos(0.0);
  const CoordinateDrive& hinge = joint(s, "hinge").drives[0];
  CHECK(hinge.limits.lower == doctest::Approx(-right));
  CHECK(hinge.limits.upper == doctest::Approx(right / 2));
  CHECK(hinge.limits.restitution == 0.5);
  CHECK(hinge.motor.kind == MotorKind::position);
  CHECK(hinge.motor.target == doctest::Approx(right / 3));
  CHECK(hinge.motor.max_force == 5);
  CHECK(joint(s, "hinge").break_torque == 9);
  CHECK(joint(s, "hinge").break_force == no_bound);
  const JointDrives& sleeve = joint(s, "sleeve").drives;
  CHECK(sleeve[0].spring.rest == 0.25);
  CHECK(sleeve[0].friction == 2);
  CHECK(sleeve[1].motor.kind == MotorKind::velocity);
  CHECK(sleeve[1].motor.max_force == no_bound);
  CHECK(sleeve[1].armature == 0.5);
  CHECK(joint(s, "rope").drives[0].limits.upper == 2);
}

TEST_CASE("coordinates that follow others: by name, of copies, in the units of the coordinate") {
  const BuiltScene s = with_joints(R"j(
    "follower": {"kind": "revolute", "b": "b", "couple": {"joint": "leader", "ratio": -2, "offset_deg": 90}},
    "leader": {"kind": "revolute", "b": "a"},
    "screw": {"kind": "cylindrical", "a": "a", "b": "b", "position": {"couple": {"coordinate": "angle", "ratio": 0.001, "offset": 0.5}}},
    "train": {"kind": "revolute", "b": "link[i]", "count": 2, "couple": {"joint": "screw", "coordinate": "position", "ratio": "= 3*(1+1)"}},
    "next": {"kind": "revolute", "b": "link[i+2]", "count": 2, "couple": {"joint": "train[i]"}})j");
  const CoordinateCouple& gear = *joint(s, "follower").drives[0].couple;
  CHECK(gear.joint == s.joints.find("leader")->second);
  CHECK(gear.coordinate == 0);
  CHECK(gear.ratio == -2);
  CHECK(gear.offset == doctest::Approx(std::acos(0.0)));
  const CoordinateCouple& screw = *joint(s, "screw").drives[0].couple;
  CHECK(screw.joint.is_null());
  CHECK(screw.coordinate == 1);
  CHECK(screw.offset == 0.5);
  CHECK(joint(s, "train[1]").drives[0].couple->ratio == 6);
  CHECK(joint(s, "next[1]").drives[0].couple->joint == s.joints.find("train[1]")->second);
}

TEST_CASE("couplings and courses that mean nothing are faults, and say what would be") {
  const auto says = [](const std::string& keys, const std::string& expected) {
    const std::string text = all_text(faults_of("\"j\": {\"b\": \"b\", " + keys + "}"));
    CHECK_MESSAGE(text.find(expected) != std::string::npos, text);
  };
  says(R"("kind": "revolute", "couple": {"joint": "nobody"})", "joints.j.couple.joint");
  says(R"("kind": "revolute", "couple": {})", "cannot be coupled to itself");
  says(R"("kind": "cylindrical", "angle": {"couple": {"coordinate": "angle"}})",
       "cannot be coupled to itself");
  says(R"("kind": "cylindrical", "angle": {"couple": {}})",
       "the coordinates of a cylindrical joint are: position, angle");
  says(R"("kind": "revolute", "couple": {"joint": "j", "coordinate": "position"})",
       "the coordinates of a revolute joint are: angle");
  says(R"("kind": "revolute", "couple": {"joint": "j", "offset": 1})", "write the key with _deg");
  says(R"j("kind": "revolute", "motor": {"velocity": "= sin(u)"})j", "u");
  says(R"j("kind": "revolute", "motor": {"velocity": "= log(t)"})j", "not finite at t = 0");
  says(R"("kind": "revolute", "motor": {"velocity": [[1, 2], [0, 3]]})", "times must ascend");
  says(R"("kind": "revolute", "motor": {"velocity": [1, 2]})", "array of 2 numbers");
}

TEST_CASE("couplings that no motion fulfils are faults") {
  const auto first = [](const std::string& joints) {
    const std::string text = all_text(faults_of(joints));
    INFO(text);
    return text;
  };
  const auto says = [&](const std::string& joints, const std::string& expected) {
    const std::string text = first(joints);
    CHECK_MESSAGE(text.find(expected) != std::string::npos, text, " should say ", expected);
  };
  const auto hinge = [](const std::string& name, const std::string& body, const std::string& keys) {
    return "\"" + name + "\": {\"kind\": \"revolute\", \"b\": \"" + body + "\", " + keys + "}";
  };
  says(hinge("j", "b", R"("couple": {"joint": "j", "ratio": 2, "offset_deg": 30})"),
       "cannot be coupled to itself");
  // 2 * 2 * 2 = 8: x = 8 x + 8 * 10 deg only at -80/7 deg.
  const auto circle = [&](const std::string& of_k, const std::string& of_l) {
    return hinge("j", "a", R"("couple": {"joint": "l", "ratio": 2, "offset_deg": 10})") + "," +
           hinge("k", "b", "\"couple\": {\"joint\": \"j\", " + of_k + "}") + "," +
           hinge("l", "link[0]", "\"couple\": {\"joint\": \"k\", " + of_l + "}");
  };
  says(circle("\"ratio\": 2", "\"ratio\": 2"),
       "joints.j: is coupled to itself (through 'l', 'k', 'j') by x = 8 x + 10 deg, which only "
       "-1.42857 deg fulfils");
  says(circle("\"ratio\": 2", R"("ratio": 0.25, "offset_deg": -10)"), "by x = x - 10 deg, which");
  says(circle("\"ratio\": 2", "\"ratio\": 0.25"), "by x = x + 10 deg, which nothing fulfils");
  with_joints(circle("\"ratio\": 2", R"("ratio": 0.25, "offset_deg": -5)"));
  // Motors of any strength: j = -2 k, so 1 rad/s here is -0.5 rad/s there.
  const auto motors = [&](const std::string& of_j, const std::string& of_k) {
    return hinge("j", "a",
                 "\"couple\": {\"joint\": \"k\", \"ratio\": -2}, \"motor\": {" + of_j + "}") +
           "," + hinge("k", "b", "\"motor\": {" + of_k + "}");
  };
  says(motors("\"velocity\": 1", "\"velocity\": 1"),
       "joints.k: its motor holds 1 rad/s, but the couplings and the motor at 'j', which holds 1 "
       "rad/s, ask for -0.5 rad/s");
  says(motors("\"velocity\": \"= 2*t\"", "\"velocity\": \"= t\""), "no motion fulfils both");
  with_joints(motors("\"velocity\": 1", "\"velocity\": -0.5"));
  with_joints(motors("\"velocity\": \"= 2*t\"", "\"velocity\": \"= -t\""));
  with_joints(motors("\"velocity\": 1", R"("velocity": 1, "max_force": 5)"));
  says(hinge("j", "a", R"("couple": {"joint": "k", "ratio": 0}, "motor": {"velocity": 1})") + "," +
           hinge("k", "b", "\"collide\": true"),
       "lets it stand");
}

TEST_CASE("equations of joints that depend on others are counted") {
  const auto rank = [](const std::string& joints) { return joint_rank(with_joints(joints)); };
  const std::string hinge = R"("j": {"kind": "revolute", "b": "b", "anchor": [1, 4, 3])";
  CHECK(rank(hinge + "}").rows == 5);
  CHECK(rank(hinge + "}").rank == 5);
  CHECK(rank(hinge + R"(, "motor": {"velocity": 1}})").rank == 6);
  // Two hinges of a door on one axis: the body keeps one freedom of six.
  const JointRank door =
      rank(hinge + R"(}, "k": {"kind": "revolute", "b": "b", "anchor": [1, 4, 4]})");
  CHECK(door.rows == 10);
  CHECK(door.rank == 5);
  REQUIRE(door.dependent.size() == 1);
  CHECK(text_of(door) == "joint rows: 10, rank 5, dependent: 5 of 'k'");
  // Two hinges that follow each other one to one are tied twice.
  const std::string pair =
      hinge + R"(, "couple": {"joint": "l"}}, "l": {"kind": "revolute", "b": "a",
    "anchor": [1, 2, 3], "couple": {"joint": "j"}})";
  CHECK(rank(pair).rows == 12);
  CHECK(rank(pair).rank == 11);
}

TEST_CASE("joints that do not begin as they are to be say by how much") {
  const auto warns = [](const std::string& joints, const std::string& expected) {
    const BuiltScene s = with_joints(joints);
    std::string text;
    for (const std::string& line : s.warnings) text += line + "\n";
    CHECK_MESSAGE((expected.empty() ? text.empty() : text.find(expected) != std::string::npos),
                  text, " should say ", expected);
  };
  const std::string turned =
      R"("j": {"kind": "revolute", "b": "b", "anchor": [1, 4, 3], "start_deg": 90, )";
  warns(turned + R"("limits": {"lower_deg": -10, "upper_deg": 10}})",
        "joints.j: begins at 90 deg, 80 deg beyond its upper limit of 10 deg");
  warns(turned + R"("limits": {"lower_deg": 100, "stiffness": 5}})",
        "10 deg beyond its lower limit of 100 deg; the limit's stiffness");
  warns(turned + R"("limits": {"upper_deg": 90.0001}})", "");
  const std::string leader = R"(, "k": {"kind": "revolute", "b": "a", "anchor": [1, 2, 3]})";
  warns(turned + R"("couple": {"joint": "k", "offset_deg": 60}})" + leader,
        "joints.j: begins at 90 deg, but 'k', which it is coupled to, begins at 0 deg and asks for "
        "60 "
        "deg: 30 deg off");
  warns(turned + R"("couple": {"joint": "k", "offset_deg": 90}})" + leader, "");
}

TEST_CASE("targets of motors and ways of kinematic bodies over time") {
  const SceneRead read =
      read_scene(scene_with(R"("parameters": {"size": 3}, "bodies": {"car": {"type": "kinematic",
        "shape": {"type": "sphere", "radius": 0.1}, "course": {"x": "= size*t", "angle_deg": [[0, 0], [2, 360]]}},
        "arm": {"shape": {"type": "sphere", "radius": 0.1}, "position": [9, 9, 9]}},
        "joints": {"j": {"kind": "revolute", "b": "arm", "motor": {"position_deg": "= 90*t", "stiffness": 4}},
                   "k": {"kind": "prismatic", "b": "arm", "motor": {"force": "= size*2"}}})"),
                 "x.json");
  INFO(all_text(read.faults));
  REQUIRE(read.ok());
  auto made = build_world(read.scene);
  REQUIRE(made.ok());
  const CoordinateMotor& motor = joint(*made, "j").drives[0].motor;
  REQUIRE(motor.course);
  CHECK(motor.course->at(1) == doctest::Approx(std::acos(0.0)));
  CHECK(joint(*made, "k").drives[0].motor.target == 6);
  CHECK_FALSE(joint(*made, "k").drives[0].motor.course);
  REQUIRE(made->world->step().ok());
  const RigidBody& car = *made->world->body(made->bodies.find("car")->second);
  CHECK(car.pose.x.x() == doctest::Approx(3.0 / 60));
  CHECK(car.omega.z() == doctest::Approx(2 * std::acos(0.0)));
  // Written again they are what they were.
  const SceneRead again = read_scene(write_scene(read.scene), "y.json");
  INFO(write_scene(read.scene));
  REQUIRE(again.ok());
  CHECK(write_scene(again.scene) == write_scene(read.scene));
}

TEST_CASE("what acts along coordinates is refused where it means nothing") {
  const auto says = [](const std::string& keys, const std::string& expected) {
    const std::string text = all_text(faults_of("\"j\": {" + keys + "}"));
    CHECK_MESSAGE(text.find(expected) != std::string::npos, text);
  };
  says(R"("kind": "rigid", "b": "b", "friction": 1)", "leaves nothing to act on");
  says(R"("kind": "planar", "b": "b", "friction": 1)",
       "the coordinates of a planar joint are: x, y, angle");
  says(R"("kind": "revolute", "b": "b", "position": {"friction": 1})", "revolute joint are: angle");
  says(R"("kind": "revolute", "b": "b", "limits": {"lower": 0})", "write the key with _deg");
  says(R"("kind": "prismatic", "b": "b", "limits": {"lower_deg": 0})",
       "write the key without _deg");
  says(R"("kind": "prismatic", "b": "b", "limits": {"lower": 1, "upper": 0})",
       "above the upper one");
  says(R"("kind": "prismatic", "b": "b", "motor": {"velocity": 1, "force": 2})", "exactly one of");
  says(R"("kind": "prismatic", "b": "b", "motor": {"position": 1})", "needs a stiffness above 0");
}

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
