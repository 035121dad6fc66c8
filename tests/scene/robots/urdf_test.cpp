// URDF robots. References: frames, masses and tensors written out by hand; the list of faults that
// each wrong file has; for tensors that no body has, the second moments of mass by hand.
#include "engine/scene/robot_files/link_mass.hpp"
#include "engine/scene/robot_files/physical_inertia.hpp"
#include "tests/scene/robots/robot_text.hpp"

#include <cmath>
#include <numbers>

#include <zlib.h>

using namespace tumble;
using namespace tumble::test;

namespace {

const std::string unit_mass_link =
    R"(<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>)";

std::string rod(const std::string& name, const std::string& members = unit_mass_link) {
  return "<link name=\"" + name + "\">" + members + "</link>\n";
}
std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& members = "") {
  return fmt::format(
             R"(<joint name="{}" type="{}"><parent link="{}"/><child link="{}"/>{}</joint>)", name,
             type, parent, child, members) +
         "\n";
}
const std::string limit = R"(<limit lower="-1" upper="2" effort="30" velocity="4"/>)";

RobotParts made(ReadRobot& read, RobotOptions options = {}) {
  INFO(log_text(read.log));
  REQUIRE(read.log.ok());
  RobotParts parts = make_robot(read.model, options, read.log);
  INFO(log_text(read.log));
  REQUIRE(read.log.ok());
  return parts;
}

double apart(const Mat3& a, const Mat3& b) {
  return (a - b).norm();
}

constexpr double right_angle = std::numbers::pi / 2;

}  // namespace

TEST_CASE("urdf: mass, centre and tensor of a link are in its own frame") {
  // Turned by 90 degrees about z, the x axis of the inertial frame is the link's y axis.
  ReadRobot r = urdf(rod("a", R"(<inertial><origin xyz="0.1 0.2 0.3" rpy="0 0 1.5707963267948966"/>
      <mass value="2"/><inertia ixx="3" ixy="0.5" ixz="0" iyy="4" iyz="0" izz="5"/></inertial>)"));
  REQUIRE(r.log.ok());
  const MassProperties& m = r.model.links[0].mass;
  CHECK(m.mass == 2);
  CHECK(m.centre == Vec3(0.1, 0.2, 0.3));
  const Mat3 expected(4, -0.5, 0, -0.5, 3, 0, 0, 0, 5);
  CHECK(apart(m.inertia, expected) < 1e-12);
  const RobotParts parts = made(r, {.base = RobotBase::floating});
  const BodyDescription& body = *parts.scene.bodies.find("a");
  CHECK(body.mass == 2);
  CHECK((*body.inertia - Vec3(4, 3, 5)).norm() < 1e-12);
  CHECK((*body.products - Vec3(-0.5, 0, 0)).norm() < 1e-12);
  CHECK((*body.centre - Vec3(0.1, 0.2, 0.3)).norm() < 1e-15);
}

TEST_CASE("urdf: rpy turns about fixed axes, x first, z of the file points up") {
  ReadRobot r = urdf(rod("a") + rod("b") +
                     joint("j", "revolute", "a", "b",
                           R"(<origin xyz="1 2 3" rpy="1.5707963267948966 0 1.5707963267948966"/>
                              <axis xyz="0 0 2"/>)" +
                               limit));
  const RobotParts parts = made(r);
  // Rz(90) Rx(90): z goes to -y and on to x.
  CHECK((r.model.links[1].in_parent.q * Vec3::UnitZ() - Vec3::UnitX()).norm() < 1e-12);
  const BodyDescription& b = *parts.scene.bodies.find("b");
  CHECK((b.placement.position - Vec3(1, 3, -2)).norm() < 1e-12);
  const JointDescription& j = *parts.scene.joints.find("j");
  CHECK(j.kind == JointKind::revolute);
  CHECK(j.a == "");  // the base is the world: it shows nothing
  CHECK((j.anchor - Vec3(1, 3, -2)).norm() < 1e-12);
  CHECK((j.axis - Vec3(1, 0, 0)).norm() < 1e-12);
  CHECK(*j.drive.limits->lower_deg == doctest::Approx(-180 / std::numbers::pi));
  CHECK(*j.drive.limits->upper_deg == doctest::Approx(360 / std::numbers::pi));
  CHECK(j.drive.motor->max_force == 30);
  CHECK(j.drive.motor->position_deg->value == 0);
}

TEST_CASE("urdf: kinds of joints") {
  ReadRobot r =
      urdf(rod("a") + rod("b") + rod("c") + rod("d") + rod("e") + rod("f") +
           joint("slide", "prismatic", "a", "b",
                 R"(<axis xyz="0 1 0"/><limit lower="0.25" upper="0.5" effort="9"/>)") +
           joint("wheel", "continuous", "a", "c", R"(<dynamics damping="0.5" friction="0.25"/>)") +
           joint("stuck", "fixed", "a", "d", R"(<origin xyz="0 0 1"/>)") +
           joint("loose", "floating", "a", "e", R"(<origin xyz="5 0 0"/>)") +
           joint("sheet", "planar", "a", "f", R"(<axis xyz="0 0 1"/>)"));
  const RobotParts parts = made(r, {.base = RobotBase::floating});
  const auto& joints = parts.scene.joints;
  CHECK(parts.scene.bodies.size() == 5);
  CHECK(parts.scene.bodies.find("a")->mass == 2);  // with d, which is welded to it
  CHECK((*parts.scene.bodies.find("a")->centre - Vec3(0, 0, 0.5)).norm() < 1e-12);
  CHECK(joints.size() == 3);
  const JointDescription& slide = *joints.find("slide");
  CHECK(slide.kind == JointKind::prismatic);
  CHECK(*slide.start == 0.25);  // 0 is beyond its limits
  CHECK(*slide.drive.limits->upper == 0.5);
  CHECK(warns(r.log, "r.urdf:", "starts at its limit 0.25"));
  CHECK((parts.scene.bodies.find("b")->placement.position - Vec3(0, 0, -0.25)).norm() < 1e-12);
  const JointDescription& wheel = *joints.find("wheel");
  CHECK(!wheel.drive.limits);
  CHECK(wheel.drive.spring->damping == 0.5);
  CHECK(wheel.drive.friction == 0.25);
  CHECK((wheel.axis - Vec3::UnitX()).norm() < 1e-12);  // unless given
  CHECK(joints.find("sheet_x")->kind == JointKind::planar);
  CHECK((parts.scene.bodies.find("e")->placement.position - Vec3(5, 0, 0)).norm() < 1e-12);
}

TEST_CASE("urdf: shapes, colours, and what is drawn apart from what collides") {
  ReadRobot r = urdf(R"(<material name="red"><color rgba="1 0 0 1"/></material>)" +
                     rod("a", unit_mass_link + R"(
        <visual><geometry><sphere radius="0.5"/></geometry><material name="red"/></visual>
        <visual><geometry><box size="1 2 3"/></geometry><material name="blue"><color rgba="0 0 1 1"/></material></visual>
        <collision><origin xyz="0 0 1"/><geometry><cylinder radius="0.1" length="0.4"/></geometry></collision>
        <collision><geometry><capsule radius="0.2" length="0.6"/></geometry></collision>)"));
  const RobotParts parts = made(r, {.base = RobotBase::floating});
  const BodyDescription& a = *parts.scene.bodies.find("a");
  REQUIRE(a.shapes.size() == 2);
  REQUIRE(a.drawn.size() == 2);
  CHECK(a.drawn[0].colour->r == 1);
  CHECK(a.drawn[1].colour->b == 1);
  // The cylinder's axis, Tumble's y, lies along the file's z.
  const Pose cylinder = a.shapes[0].placement.pose();
  CHECK((cylinder.q * Vec3::UnitY() - Vec3::UnitZ()).norm() < 1e-12);
  CHECK(cylinder.x == Vec3(0, 0, 1));
  CHECK(parts.bounds.max.y() == doctest::Approx(1.5));   // the box
  CHECK(parts.bounds.min.z() == doctest::Approx(-1.0));  // its y
}

TEST_CASE("urdf: a tensor that no body has becomes the nearest that one has") {
  // Second moments S = tr(I)/2 - I: (2, 1, -1); with -1 set to 0, I = tr(S) - S = (1, 2, 3).
  const auto p = physical_inertia(Vec3(-1 + 1, 1, 3).asDiagonal());
  REQUIRE(p);
  CHECK(p->changed);
  CHECK(apart(p->inertia, Mat3(Vec3(1, 2, 3).asDiagonal())) < 1e-12);
  const Mat3 R = axis_angle(Vec3(1, 2, 3), 0.7).toRotationMatrix();
  const auto turned = physical_inertia(R * Vec3(0, 1, 3).asDiagonal() * R.transpose());
  CHECK(apart(turned->inertia, R * Vec3(1, 2, 3).asDiagonal() * R.transpose()) < 1e-12);
  const auto plate = physical_inertia(Vec3(1, 2, 3).asDiagonal());
  CHECK_FALSE(plate->changed);
  CHECK_FALSE(physical_inertia(Mat3::Zero()));
  CHECK_FALSE(physical_inertia(-Mat3::Identity()));

  const ReadRobot r = urdf(
      "<link name=\"a\"><inertial>\n<mass value=\"1\"/>\n<inertia ixx=\"0.5\" iyy=\"1\" "
      "izz=\"3\"/></inertial></link>");
  CHECK(warns(r.log, "r.urdf:4: ", "0.5, 1, 3"));
}

TEST_CASE("urdf: missing inertia is that of the geometry, a missing mass welds") {
  const double radius = 0.5, mass = 10;
  ReadRobot ball = urdf(rod("a", R"(<inertial><mass value="10"/></inertial>
      <collision><geometry><sphere radius="0.5"/></geometry></collision>)"));
  CHECK(ball.model.links[0].mass.inertia(1, 1) ==
        doctest::Approx(0.4 * mass * radius * radius).epsilon(1e-12));
  CHECK(warns(ball.log, "r.urdf:2: ", "no inertia"));

  // Two hinges that cross at a link without mass are one universal joint.
  ReadRobot cross = urdf(rod("a") + rod("m", "") + rod("b") +
                         joint("p", "continuous", "a", "m", R"(<axis xyz="0 0 1"/>)") +
                         joint("q", "continuous", "m", "b", R"(<axis xyz="0 1 0"/>)"));
  const RobotParts parts = made(cross);
  REQUIRE(parts.scene.joints.size() == 1);
  const JointDescription& u = parts.scene.joints.items[0].value;
  CHECK(u.kind == JointKind::universal);
  CHECK((u.axis - Vec3::UnitY()).norm() < 1e-12);
  CHECK((*u.axis_b + Vec3::UnitZ()).norm() < 1e-12);

  // One that nothing hangs on cannot move.
  ReadRobot leaf =
      urdf(rod("a") + rod("m", "") + joint("p", "continuous", "a", "m", R"(<axis xyz="0 0 1"/>)"));
  CHECK(made(leaf, {.base = RobotBase::floating}).scene.bodies.size() == 1);
  CHECK(warns(leaf.log, "r.urdf:3: ", "'m' has no mass: it is welded to what it hangs on, and p"));
}

TEST_CASE("urdf: what is not followed is said with its line") {
  ReadRobot r = urdf(rod("a") + rod("b") + "<gazebo reference=\"a\"/>\n" +
                     joint("j", "revolute", "a", "b",
                           "<limit lower=\"0\" upper=\"1\" effort=\"1\" velocity=\"3\"/>\n<mimic "
                           "joint=\"k\" multiplier=\"2\"/>\n<safety_controller k=\"1\"/>"));
  INFO(log_text(r.log));
  CHECK(warns(r.log, "r.urdf:4: ", "<gazebo> is not followed"));
  CHECK(warns(r.log, "r.urdf:5: ", "'velocity' is not followed"));
  CHECK(warns(r.log, "r.urdf:7: ", "<safety_controller>"));
  REQUIRE(r.model.links[1].joints[0].mimic);
  CHECK(r.model.links[1].joints[0].mimic->multiplier == 2);
  const ReadRobot fixed = urdf(rod("a") + rod("b") + rod("c") +
                               joint("j", "continuous", "a", "b", "<mimic joint=\"k\"/>") +
                               joint("k", "fixed", "b", "c"));
  CHECK(warns(fixed.log, "r.urdf:5: ", "'j' does not follow 'k', which is fixed"));
  CHECK_FALSE(fixed.model.links[1].joints[0].mimic);
  const ReadRobot twice = urdf("<link name=\"a\" odd=\"1\"/>\n<link name=\"b\" odd=\"1\"/>");
  CHECK(warns(twice.log, "r.urdf:2: ", "<link>: 'odd' is not followed (also in line 3)"));
}

TEST_CASE("urdf: a link that is denser than any matter is named, with what would be one") {
  const auto link = [](double inertia, const std::string& members) {
    return fmt::format(R"(<link name="a"><inertial><mass value="2"/><inertia ixx="{0}" iyy="{0}" )"
                       R"(izz="{0}" ixy="0" ixz="0" iyz="0"/></inertial>{1}</link>)",
                       inertia, members);
  };
  // A ball of density d: r^3 = 3 m / (4 pi d), I = 0.4 m r^2; of osmium 6.1e-4, of water 4.9e-3.
  const double osmium = 0.8 * std::pow(1.5 / (std::numbers::pi * 22590), 2.0 / 3);
  CHECK(log_text(urdf(link(1.01 * osmium, "")).log).find("denser") == std::string::npos);
  const ReadRobot bare = urdf(link(0.99 * osmium, ""));
  CHECK(warns(bare.log, "r.urdf:2: ", "denser than any matter"));
  CHECK(warns(bare.log, "r.urdf:2: ", "a ball of water has 0.00489"));
  // m (a^2 + b^2) / 12 of a cube.
  const ReadRobot cube =
      urdf(link(1e-9, R"(<collision><geometry><box size="1 1 1"/></geometry></collision>)"));
  CHECK(warns(cube.log, "r.urdf:2: ", "its geometry, evenly filled, 0.333"));
}

TEST_CASE("urdf: a mimic becomes a coupling, in radians and metres, where its leader puts it") {
  const auto mimic = [](const std::string& leader, double multiplier, double offset) {
    return fmt::format(R"(<axis xyz="0 0 1"/><mimic joint="{}" multiplier="{}" offset="{}"/>)",
                       leader, multiplier, offset);
  };
  const std::string axis = R"(<axis xyz="0 0 1"/>)";
  ReadRobot r = urdf(rod("a") + rod("b") + rod("c") + rod("d") + rod("e") +
                     joint("lead", "revolute", "a", "b", axis + limit) +
                     joint("turn", "revolute", "a", "c", mimic("lead", -2, 0.1) + limit) +
                     joint("slide", "prismatic", "a", "d", mimic("turn", 0.5, 0) + limit) +
                     joint("wind", "continuous", "a", "e", mimic("lead", 10, 0)));
  const RobotParts parts = made(r, {.prefix = "arm_", .start = {{"lead", 0.4}}});
  const auto coupled = [&](const std::string& name) -> const JointDescription& {
    const JointDescription* found = parts.scene.joints.find("arm_" + name);
    REQUIRE(found);
    return *found;
  };
  CHECK_FALSE(coupled("lead").drive.couple);
  REQUIRE(coupled("lead").drive.motor);
  const JointDescription& turn = coupled("turn");
  REQUIRE(turn.drive.couple);
  CHECK_FALSE(turn.drive.motor);
  CHECK(turn.drive.couple->joint == "arm_lead");
  CHECK(turn.drive.couple->ratio == -2);
  CHECK(*turn.drive.couple->offset_deg == doctest::Approx(0.1 * 180 / std::numbers::pi));
  CHECK(*turn.start_deg == doctest::Approx((0.1 - 0.8) * 180 / std::numbers::pi));
  const JointDescription& slide = coupled("slide");
  REQUIRE(slide.drive.couple);
  CHECK(slide.drive.couple->joint == "arm_turn");
  CHECK_FALSE(slide.drive.couple->offset);
  CHECK(*slide.start == doctest::Approx(-0.35));
  // Beyond half a turn it is counted from where it starts, which the offset knows.
  const JointDescription& wind = coupled("wind");
  CHECK_FALSE(wind.start_deg);
  CHECK(*wind.drive.couple->offset_deg == doctest::Approx(-4 * 180 / std::numbers::pi));
}

TEST_CASE("urdf: what cannot follow says why, and moves by itself") {
  const auto pair = [](const std::string& first, const std::string& second) {
    return rod("a") + rod("b") + rod("c") +
           joint("j", "continuous", "a", "b", "<mimic joint=\"" + first + "\"/>") +
           joint("k", "continuous", "b", "c", second);
  };
  ReadRobot unknown = urdf(pair("kk", ""));
  CHECK_FALSE(made(unknown).scene.joints.find("j")->drive.couple);
  CHECK(warns(unknown.log, "r.urdf:5: ", "joint 'j' does not follow 'kk'"));
  CHECK(warns(unknown.log, "r.urdf:5: ", "did you mean 'k'"));
  ReadRobot circle = urdf(pair("k", "<mimic joint=\"j\"/>"));
  CHECK(made(circle).scene.joints.size() == 2);
  CHECK(warns(circle.log, "r.urdf:5: ", "in a circle"));
  ReadRobot still = urdf(rod("a") + rod("b") + rod("c") +
                         joint("j", "continuous", "a", "b", "<mimic joint=\"f\"/>") +
                         joint("f", "fixed", "a", "c"));
  CHECK_FALSE(made(still).scene.joints.find("j")->drive.couple);
  CHECK(warns(still.log, "r.urdf:5: ", "does not follow 'f'"));
  ReadRobot told = urdf(pair("k", ""));
  make_robot(told.model, {.start = {{"j", 1}}}, told.log);
  CHECK(all_text(told.log.faults()).find("say where that one starts") != std::string::npos);
}

TEST_CASE("urdf: faults have a line, a cause and a cure") {
  const auto fault = [](const std::string& members) {
    const ReadRobot r = urdf(members);
    return r.log.ok() ? std::string("none") : r.log.faults()[0].text();
  };
  const auto says = [&](const std::string& members, const std::string& text) {
    const std::string found = fault(members);
    CHECK_MESSAGE(found.find(text) != std::string::npos, found, " should say ", text);
  };
  says("", "r.urdf:1: has no <link>");
  says(rod("a") + rod("a"), "r.urdf:3: a second link 'a'");
  says(rod("a") + rod("b"), "r.urdf:3: both 'a' and 'b' hang on no joint");
  says(rod("arm") + joint("j", "fixed", "arm", "arn"), "did you mean 'arm'");
  says(rod("a") + joint("j", "fixed", "a", "a"), "joint 'j' hangs link 'a' on itself");
  says(rod("a") + rod("b") + joint("j", "fixed", "a", "b") + joint("k", "fixed", "b", "a"),
       "every link hangs on another");
  says(rod("a") + rod("b") +
           joint("j", "revolute", "a", "b", R"(<limit lower="1" upper="2" effort="-5"/>)"),
       "'effort' must not be negative, got -5");
  says(rod("a") + rod("b") + rod("c") + joint("j", "fixed", "a", "c") +
           joint("k", "fixed", "b", "c"),
       "r.urdf:6: link 'c' hangs on two joints, 'j' and 'k'");
  says(rod("a") + rod("b") + joint("j", "turning", "a", "b"), "got 'turning'");
  says(rod("a") + "<joint type=\"fixed\"><parent link=\"a\"/></joint>", "'name' is missing");
  says(rod("a") + "<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/></joint>",
       "has no <child>");
  says(rod("a") + rod("b") +
           joint("j", "revolute", "a", "b", R"(<limit lower="2" upper="1" effort="1"/>)"),
       "'lower' 2 is above 'upper' 1");
  says(rod("a") + rod("b") + joint("j", "continuous", "a", "b", R"(<axis xyz="0 0 0"/>)"),
       "an axis of zeros");
  says(rod("a", R"(<collision><geometry><box size="1 1"/></geometry></collision>)"),
       "<box>: 'size' needs 3 numbers, got 2");
  says(rod("a", R"(<collision><geometry><box size="1 x 1"/></geometry></collision>)"),
       "'x' is not a number");
  says(rod("a", R"(<collision><geometry><sphere radius="-1"/></geometry></collision>)"),
       "must be above 0, got -1");
  says(rod("a", R"(<collision><geometry><torus/></geometry></collision>)"), "<torus> is no shape");
  says(rod("a", R"(<collision></collision>)"), "no <geometry>");
  says(rod("a", R"(<inertial><mass value="-1"/></inertial>)"), "must not be negative");
  says("<xacro:macro/>", "xacro");
  says("<link name=\"a\">", "not well-formed XML");
  const auto says_alone = [](const char* text, const char* cause) {
    CHECK(robot_of_text(text, "r.urdf").log.faults()[0].text().find(cause) != std::string::npos);
  };
  says_alone("<!-- nothing -->", "no element");
  says_alone("", "the file is empty");
}

TEST_CASE("urdf: a packed file is read as the plain one, a cut one is a fault") {
  const ScratchFolder folder("urdf_gz");
  const std::string text = "<robot name=\"r\">" + rod("a") + "</robot>";
  const auto plain = folder.write("r.urdf", text);
  const std::string packed = (folder.path / "r.urdf.gz").string();
  gzFile out = gzopen(packed.c_str(), "wb");
  REQUIRE(gzwrite(out, text.data(), unsigned(text.size())) == int(text.size()));
  gzclose(out);
  CHECK(is_robot_file(packed));
  RobotLog log;
  const RobotModel a = read_robot_file(plain, {}, log), b = read_robot_file(packed, {}, log);
  REQUIRE(log.ok());
  CHECK(a.links[0].mass.inertia == b.links[0].mass.inertia);
  const std::string bytes = file_text(packed);
  RobotLog of_cut;
  read_robot_file(folder.write("cut.urdf.gz", bytes.substr(0, bytes.size() / 2)), {}, of_cut);
  REQUIRE_FALSE(of_cut.ok());
  CHECK(of_cut.faults()[0].text().find("cut gzip") != std::string::npos);
}

TEST_CASE("package:// is found by option, by environment and upwards from the file") {
  const ScratchFolder folder("packages");
  const std::string obj = file_text(data_file("tetra.obj"));
  const auto urdf_file = folder.write("up/parts/urdf/r.urdf", "");
  const RobotPlace at{std::make_shared<const std::string>("r.urdf"), 7};
  const auto look = [&](const std::string& name, const PackageFolders& packages) {
    RobotLog log;
    const auto found = find_asset(name, urdf_file, packages, at, log);
    CHECK(found.has_value() == log.warnings().empty());
    if (!found) CHECK(log.warnings()[0].starts_with("r.urdf:7: there is no "));
    return found;
  };
  const auto above = folder.write("up/parts/meshes/t.obj", obj);
  CHECK(look("package://parts/meshes/t.obj", {}) == above);
  CHECK(look("../meshes/t.obj", {})->lexically_normal() == above);
  CHECK(look("file://" + above.string(), {}) == above);
  CHECK_FALSE(look("package://parts/meshes/u.obj", {}));
  CHECK_FALSE(look("package://other/t.obj", {}));
  const auto elsewhere = folder.write("else/o/t.obj", obj);
  CHECK(look("package://other/t.obj", {{"other", folder.path / "else/o"}}) == elsewhere);
  const auto by_path = folder.write("ros/other/t.obj", obj);
  ::setenv("ROS_PACKAGE_PATH", ("/nowhere:" + (folder.path / "ros").string()).c_str(), 1);
  CHECK(look("package://other/t.obj", {}) == by_path);
  ::unsetenv("ROS_PACKAGE_PATH");
}
