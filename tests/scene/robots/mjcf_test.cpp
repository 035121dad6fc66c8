// MJCF robots. References: frames, masses and gains written out by hand; the list of faults that
// each wrong file has. The samples of MuJoCo against its own reader: mujoco_samples_test.cpp.
#include "engine/scene/robot_files/joint_series.hpp"
#include "tests/scene/robots/robot_text.hpp"

#include <numbers>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double pi = std::numbers::pi;

RobotParts parts_of(ReadRobot& read, RobotOptions options = {}) {
  INFO(log_text(read.log));
  REQUIRE(read.log.ok());
  RobotParts parts = make_robot(read.model, options, read.log);
  INFO(log_text(read.log));
  REQUIRE(read.log.ok());
  return parts;
}

}  // namespace

TEST_CASE("mjcf: defaults of nested classes, of childclass, and an element's own") {
  ReadRobot r = mjcf(R"(
    <default><geom density="500"/><joint damping="1"/>
      <default class="arm"><geom type="box" size="1 1 1"/><joint axis="1 0 0"/>
        <default class="hand"><joint axis="0 1 0" damping="7"/></default></default></default>
    <worldbody><body name="a" childclass="arm"><joint name="i"/><geom/>
      <body name="b"><joint name="j" class="hand"/><geom size="1 1 2"/>
        <body name="c" childclass="main"><joint name="k"/><geom size="2"/></body></body></body>
    </worldbody>)");
  REQUIRE_MESSAGE(r.log.ok(), log_text(r.log));
  const auto& links = r.model.links;
  CHECK(links[0].mass.mass == doctest::Approx(500 * 8));
  CHECK(links[1].mass.mass == doctest::Approx(500 * 16));
  CHECK(links[2].mass.mass == doctest::Approx(500 * 4.0 / 3 * pi * 8));
  CHECK(links[0].joints[0].axis == Vec3::UnitX());
  CHECK(links[0].joints[0].damping == 1);
  CHECK(links[1].joints[0].axis == Vec3::UnitY());
  CHECK(links[1].joints[0].damping == 7);
  CHECK(links[2].joints[0].axis == Vec3::UnitZ());
}

TEST_CASE("mjcf: orientations in all their forms") {
  const auto turned = [](const std::string& attribute, const std::string& compiler = "") {
    const ReadRobot r = mjcf("<compiler " + compiler + "/><worldbody><body " + attribute +
                             "><geom size=\"1\"/></body></worldbody>");
    REQUIRE_MESSAGE(r.log.ok(), log_text(r.log));
    return r.model.links[0].in_parent.q;
  };
  const auto same = [](const Quat& a, const Quat& b) { return a.angularDistance(b) < 1e-12; };
  const Quat x90 = axis_angle(Vec3::UnitX(), pi / 2), y90 = axis_angle(Vec3::UnitY(), pi / 2);
  const Quat z90 = axis_angle(Vec3::UnitZ(), pi / 2);
  CHECK(same(turned("quat=\"2 2 0 0\""), x90));
  CHECK(same(turned("axisangle=\"0 3 0 90\""), y90));
  CHECK(same(turned("axisangle=\"0 3 0 1.5707963267948966\"", "angle=\"radian\""), y90));
  CHECK(same(turned("euler=\"90 90 0\""), x90 * y90));
  CHECK(same(turned("euler=\"90 90 0\"", "eulerseq=\"XYZ\""), y90 * x90));
  CHECK(same(turned("euler=\"90 90 0\"", "eulerseq=\"zyx\""), z90 * y90));
  CHECK(same(turned("zaxis=\"0 -5 0\""), x90));
  CHECK(same(turned("xyaxes=\"0 1 0 -1 1 0\""), z90));
}

TEST_CASE("mjcf: geoms, their places and masses") {
  const ReadRobot r = mjcf(R"(
    <worldbody><body>
      <geom type="capsule" fromto="0 0 0 0 0 2" size="0.5" mass="3"/>
      <geom type="box" size="0.1 0.2 0.3" pos="1 0 0" density="100" rgba="1 0 0 1" friction="0.9 1 1"/>
      <geom type="sphere" size="0.2" contype="0" conaffinity="0" mass="0"/>
      <geom type="ellipsoid" size="1 2 3" mass="1" group="3"/>
    </body></worldbody>)");
  REQUIRE_MESSAGE(r.log.ok(), log_text(r.log));
  const RobotLink& link = r.model.links[0];
  const double box = 100 * 8 * 0.006;
  CHECK(link.mass.mass == doctest::Approx(4 + box));
  CHECK(link.mass.centre.x() == doctest::Approx(box / (4 + box)));
  CHECK(link.mass.centre.z() == doctest::Approx(3 / (4 + box)));
  CHECK(link.collides.size() == 3);
  CHECK(link.drawn.size() == 3);
  CHECK(link.collides[0].pose.x == Vec3(0, 0, 1));
  CHECK(link.collides[0].shape.height == doctest::Approx(2));
  CHECK(*link.collides[1].friction == 0.9);
}

TEST_CASE("mjcf: an inertial stands for the geoms, unless the compiler says otherwise") {
  const auto mass = [](const std::string& compiler) {
    const ReadRobot r = mjcf("<compiler " + compiler + R"(/><worldbody><body>
      <inertial mass="5" pos="0 0 1" quat="1 1 0 0" fullinertia="3 4 5 0 0 0.25"/>
      <geom size="1" mass="7"/></body></worldbody>)");
    REQUIRE_MESSAGE(r.log.ok(), log_text(r.log));
    return r.model.links[0].mass;
  };
  CHECK(mass("").mass == 5);
  CHECK(mass("").centre == Vec3(0, 0, 1));
  // Turned by 90 degrees about x: y becomes z, z becomes -y.
  const Mat3 expected(3, 0, 0, 0, 5, -0.25, 0, -0.25, 4);
  CHECK((mass("").inertia - expected).norm() < 1e-12);
  CHECK(mass("inertiafromgeom=\"true\"").mass == 7);
  CHECK(mass("settotalmass=\"2\"").mass == doctest::Approx(2));
}

TEST_CASE("mjcf: actuators become what they do at control 0") {
  ReadRobot r = mjcf(R"(
    <worldbody><body name="a"><joint name="i"/><geom size="1"/></body>
      <body name="b" pos="5 0 0"><joint name="j" type="slide" range="-1 1"/><geom size="1"/></body>
      <body name="c" pos="9 0 0"><joint name="k" damping="1"/><geom size="1"/></body></worldbody>
    <actuator><position joint="i" kp="30" gear="2" ctrlrange="0.5 1"/><velocity joint="i" kv="4"/>
      <motor joint="j" gear="3"/><velocity joint="k" kv="6" forcerange="-5 5"/>
      <muscle joint="k"/></actuator>)");
  const RobotParts parts = parts_of(r);
  const MotorDescription& i = *parts.scene.joints.find("i")->drive.motor;
  CHECK(*i.stiffness == 120);  // kp gear^2
  CHECK(*i.damping == 4);
  CHECK(i.position_deg->value == doctest::Approx(0.25 * 180 / pi));  // ctrl / gear
  const DriveDescription& j = parts.scene.joints.find("j")->drive;
  CHECK(j.motor->force->value == 0);
  CHECK(*j.limits->lower == -1);
  CHECK(parts.scene.joints.find("k")->drive.spring->damping == 7);
  CHECK(warns(r.log, "m.xml:", "<muscle>"));
}

TEST_CASE("mjcf: coordinates of one body become the fewest joints") {
  const auto kinds = [](const std::string& joints, ReadRobot* out = nullptr) {
    ReadRobot r = mjcf("<worldbody><body name=\"a\">" + joints +
                       "<geom size=\"1\" mass=\"20\"/></body></worldbody>");
    const RobotParts parts = parts_of(r);
    std::string list;
    double mass = 0;
    for (const auto& j : parts.scene.joints.items)
      list += std::string(enum_name(j.value.kind)) + " ";
    for (const auto& b : parts.scene.bodies.items) mass += *b.value.mass;
    CHECK(mass == doctest::Approx(20));
    if (out) *out = std::move(r);
    return list;
  };
  CHECK(kinds("<joint/>") == "revolute ");
  CHECK(kinds("<joint type=\"ball\"/>") == "spherical ");
  CHECK(kinds("<freejoint/>").empty());
  CHECK(kinds("<joint axis=\"1 0 0\"/><joint axis=\"0 1 0\" pos=\"0 3 0\"/>") == "universal ");
  CHECK(kinds("<joint type=\"slide\"/><joint pos=\"1 0 0\"/>") == "cylindrical ");
  CHECK(
      kinds(
          "<joint type=\"slide\" axis=\"1 0 0\"/><joint type=\"slide\" axis=\"0 1 0\"/><joint/>") ==
      "planar ");
  ReadRobot r;
  CHECK(kinds("<joint axis=\"1 0 0\"/><joint axis=\"0 0 1\"/><joint axis=\"0 1 0\"/>", &r) ==
        "universal revolute ");
  CHECK(warns(r.log, "m.xml:2: ", "bodies with 5 % of its mass"));
  CHECK(kinds("<joint axis=\"1 0 0\"/><joint axis=\"1 1 0\"/>") == "revolute revolute ");
}

TEST_CASE("mjcf: ties, excludes, gravity and the world's geoms") {
  ReadRobot r = mjcf(R"(
    <option gravity="1 0 -2"/>
    <worldbody><geom name="floor" type="plane" size="1 1 1"/>
      <body name="a"><freejoint/><geom size="1"/></body>
      <body name="b" pos="0 0 3"><freejoint/><geom size="1"/></body></worldbody>
    <equality><connect body1="a" body2="b" anchor="0 0 1.5"/><weld body1="b"/>
      <connect body1="a" body2="b" anchor="0 0 9" active="false"/></equality>
    <contact><exclude body1="a" body2="b"/></contact>)");
  const RobotParts parts = parts_of(r);
  CHECK(parts.has_ground);
  CHECK(*r.model.gravity == Vec3(1, 0, -2));
  REQUIRE(parts.scene.joints.size() == 3);
  const JointDescription& connect = parts.scene.joints.items[0].value;
  CHECK(connect.kind == JointKind::spherical);
  CHECK((connect.anchor - Vec3(0, 0, 1.5)).norm() < 1e-12);
  const JointDescription& weld = parts.scene.joints.items[1].value;
  CHECK(weld.kind == JointKind::rigid);
  CHECK(weld.b == "b");
  CHECK(weld.a.empty());
  CHECK(parts.scene.joints.items[2].value.kind == JointKind::free);
}

TEST_CASE("mjcf: a linear equality of joints becomes a coupling") {
  const auto with = [](const std::string& equality) {
    return mjcf(R"(<compiler angle="radian"/><worldbody>
      <body><joint name="x" type="slide" ref="0.2"/><geom size="1"/></body>
      <body pos="4 0 0"><joint name="y" ref="0.5"/><geom size="1"/></body></worldbody>
      <equality>)" +
                equality + "</equality>");
  };
  // y - 0.5 = 0.1 + 3 (x - 0.2): no offset is left.
  ReadRobot r = with(R"(<joint joint1="y" joint2="x" polycoef="0.1 3"/>)");
  const RobotParts parts = parts_of(r);
  const JointDescription& y = *parts.scene.joints.find("y");
  REQUIRE(y.drive.couple);
  CHECK(y.drive.couple->joint == "x");
  CHECK(y.drive.couple->ratio == 3);
  CHECK(std::fabs(y.drive.couple->offset_deg.value_or(0)) < 1e-9);
  ReadRobot plain = with(R"(<joint joint1="y" joint2="x"/>)");
  CHECK(parts_of(plain).scene.joints.find("y")->drive.couple->ratio == 1);
  ReadRobot off = with(R"(<joint joint1="y" joint2="x" active="false"/>)");
  CHECK_FALSE(parts_of(off).scene.joints.find("y")->drive.couple);
  ReadRobot curved = with(R"(<joint joint1="y" joint2="x" polycoef="0 1 2"/>)");
  CHECK_FALSE(parts_of(curved).scene.joints.find("y")->drive.couple);
  CHECK(warns(curved.log, "m.xml:", "only a linear relation"));
}

TEST_CASE("mjcf: what is not followed is said, faults have a line and a cause") {
  const ReadRobot r = mjcf(
      "<worldbody>\n<body><site/>\n<geom size=\"1\" solref=\"1 1\"/><composite type=\"rope\"/>\n"
      "</body></worldbody>\n<tendon><spatial/></tendon>\n<keyframe/>");
  CHECK(warns(r.log, "m.xml:3: ", "<site>"));
  CHECK(warns(r.log, "m.xml:4: ", "'solref' is not followed"));
  CHECK(warns(r.log, "m.xml:4: ", "<composite> is not made"));
  CHECK(warns(r.log, "m.xml:6: ", "tendons"));
  CHECK(warns(r.log, "m.xml:7: ", "<keyframe>"));
  const auto says = [](const std::string& members, const std::string& text) {
    const ReadRobot wrong = mjcf(members);
    const std::string found = wrong.log.ok() ? "none" : wrong.log.faults()[0].text();
    CHECK_MESSAGE(found.find(text) != std::string::npos, found, " should say ", text);
  };
  const auto body = [](const std::string& members) {
    return "<worldbody><body name=\"a\">" + members + "</body></worldbody>";
  };
  says("", "m.xml:1: has no body and no geom");
  says("<compiler coordinate=\"global\"/>", "local");
  says(body("<geom type=\"capsule\" size=\"1\"/>"), "m.xml:2: <geom>: 'size' needs 2 numbers");
  says(body("<geom size=\"-1\"/>"), "above 0, got -1");
  says(body("<geom size=\"1\" class=\"arm\"/>") + "<default><default class=\"am\"/></default>",
       "did you mean 'am'");
  says(body("<freejoint/><joint/><geom size=\"1\"/>"), "must be the only joint");
  says(body("<geom size=\"1\"/><body name=\"b\"><freejoint/><geom size=\"1\"/></body>"),
       "only a body of the world");
  says(body("<geom size=\"1\"/><body name=\"a\"/>"), "a second body 'a'");
  says(body("<joint name=\"j\"/><joint name=\"j\"/><geom size=\"1\"/>"), "a second joint 'j'");
  says(body("<geom type=\"mesh\" mesh=\"m\"/>"), "mesh");
  says(body("<geom size=\"1\"/>") + "<actuator><motor joint=\"j\"/></actuator>", "joint");
  says(body("<geom size=\"1\"/>") + "<equality><weld body1=\"q\"/></equality>", "body");
  says("<include file=\"gone.xml\"/>", "<include>");
}

TEST_CASE("mjcf: include puts another file in its place, a circle of them is a fault") {
  const ScratchFolder folder("mjcf_include");
  folder.write("body.xml", "<mujocoinclude><body><geom size=\"1\"/></body></mujocoinclude>");
  RobotLog log;
  const auto main = folder.write(
      "main.xml", "<mujoco><worldbody><include file=\"body.xml\"/></worldbody></mujoco>");
  CHECK(read_robot_file(main, {}, log).links.size() == 1);
  CHECK(log.ok());
  RobotLog round;
  read_robot_file(folder.write("round.xml", "<mujoco><include file=\"round.xml\"/></mujoco>"), {},
                  round);
  REQUIRE_FALSE(round.ok());
  CHECK(round.faults()[0].text().find("include itself") != std::string::npos);
}
