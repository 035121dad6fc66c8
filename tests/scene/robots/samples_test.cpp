// The robots that Debian brings: MuJoCo's samples and Simbody's URDFs. Reference: MuJoCo's own
// reader, of both formats: masses, centres, tensors, places, axes, limits and springs, in its
// world. Its numbers of URDF files are in double, so that both agree to rounding.
#include "engine/scene/catalogue.hpp"
#include "engine/world/world.hpp"
#include "tests/scene/robots/robot_text.hpp"
#include "tests/support/mujoco_reader.hpp"

#include <algorithm>
#include <cmath>
#include <regex>

#include <zlib.h>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double rounding = 1e-9, single = 1e-5;

struct Agreement {
  size_t bodies = 0, joints = 0;
};

template <class List, class Item>
const typename List::value_type* counterpart(const List& list, const Item& item, size_t index,
                                             size_t count) {
  for (const auto& other : list)
    if (other.name == item.name) return &other;
  // Those without a name come in the order of the file.
  return list.size() == count && list[index].name.empty() ? &list[index] : nullptr;
}

/// Names of links whose tensor MuJoCo changes otherwise than Tumble (balanceinertia).
Agreement compare(const RobotModel& model, const MujocoModel& other,
                  const std::vector<std::string>& balanced = {}) {
  Agreement out;
  const std::vector<Pose> poses = start_poses(model);
  std::vector<MujocoJoint> theirs;
  for (const MujocoJoint& j : other.joints)
    if (j.kind != 0) theirs.push_back(j);
  size_t joints = 0;
  for (const RobotLink& l : model.links) joints += l.joints.size();
  size_t number = 0;
  for (size_t i = 0; i < model.links.size(); ++i) {
    const RobotLink& link = model.links[i];
    CAPTURE(link.name);
    const size_t first = number;
    number += link.joints.size();
    const MujocoBody* body = counterpart(other.bodies, link, i, model.links.size());
    if (!body) continue;
    ++out.bodies;
    const MassProperties m = moved(link.mass, poses[i]);
    // Its meshes have coordinates of 24 bits.
    const auto is_mesh = [](const RobotGeometry& g) { return !g.mesh.empty(); };
    const bool mesh = std::any_of(link.collides.begin(), link.collides.end(), is_mesh) ||
                      std::any_of(link.drawn.begin(), link.drawn.end(), is_mesh);
    const double slack = mesh ? single : rounding;
    CHECK(link.mass.mass == doctest::Approx(body->mass).epsilon(slack));
    CHECK((poses[i].x - body->place).norm() < rounding);
    if (link.mass.mass > 0) {
      CHECK((m.centre - body->centre).norm() < slack);
      if (std::find(balanced.begin(), balanced.end(), link.name) == balanced.end())
        CHECK((m.inertia - body->inertia).norm() < 100 * slack * body->inertia.norm() + 1e-16);
    }
    Pose before = poses[i];  // all samples start with their joints at the reference
    for (size_t k = 0; k < link.joints.size(); ++k) {
      const RobotJoint& j = link.joints[k];
      CAPTURE(j.name);
      const MujocoJoint* joint = counterpart(theirs, j, first + k, joints);
      if (!joint) continue;
      ++out.joints;
      CHECK((before.direction(j.axis) - joint->axis).norm() < rounding);
      CHECK((before.point(j.anchor) - joint->anchor).norm() < rounding);
      if (joint->limited) {
        CHECK(*j.lower == doctest::Approx(joint->lower));
        CHECK(*j.upper == doctest::Approx(joint->upper));
      }
      CHECK(j.stiffness == doctest::Approx(joint->stiffness));
      CHECK(j.damping == doctest::Approx(joint->damping));
      CHECK(j.armature == doctest::Approx(joint->armature));
      CHECK(j.friction == doctest::Approx(joint->friction));
    }
  }
  return out;
}

/// Builds the scene of a file and steps it: masses and axes as in the model, and something moves.
void step_scene(const std::string& file, const MujocoModel& other, int ticks,
                const std::vector<std::string>& overrides = {}) {
  const SceneRead read = open_scene(file, {overrides});
  BuiltScene s = build_of(read);
  for (const JointFrame& j : *s.world->frame()->joints) {
    if (j.kind != JointKind::revolute && j.kind != JointKind::prismatic) continue;
    CAPTURE(j.name);
    for (const MujocoJoint& joint : other.joints)
      if (joint.name == j.name) {
        const Vec3 axis = z_up().direction(joint.axis), anchor = z_up().point(joint.anchor);
        CHECK((j.frame_a.q * Vec3::UnitZ() - axis).norm() < rounding);
        if (j.kind == JointKind::revolute)
          CHECK((j.frame_a.x - anchor).cross(axis).norm() < rounding);
      }
  }
  const auto before = s.world->frame();
  for (int k = 0; k < ticks; ++k) REQUIRE(s.world->step().ok());
  const auto after = s.world->frame();
  double moved = 0;
  for (size_t slot = 0; slot < after->body_slots(); ++slot) {
    REQUIRE(after->body(slot).pose.x.allFinite());
    moved = std::max(moved, (after->body(slot).pose.x - before->body(slot).pose.x).norm());
    CHECK(after->body(slot).v.norm() < 50);
  }
  CHECK(moved > 1e-6);
  for (const JointFrame& j : *after->joints)
    if (j.kind == JointKind::revolute || j.kind == JointKind::universal)
      // Trees of twenty bodies that are let go: realtime leaves a joint open by a centimetre.
      CHECK((j.frame_a.x - j.frame_b.x).norm() < 2e-2);
}

std::string unpacked_text(const std::string& file) {
  std::string out(size_t{4} << 20, '\0');
  gzFile in = gzopen(file.c_str(), "rb");
  if (!in) return {};
  const int count = gzread(in, out.data(), unsigned(out.size()));
  gzclose(in);
  out.resize(size_t(std::max(count, 0)));
  return out;
}

/// What MuJoCo needs to read it: no meshes, links that stay apart, and a tensor that it accepts.
std::string for_mujoco(std::string text) {
  static const std::regex shapes("<(collision|visual)[ >][^]*?</\\1>");
  text = std::regex_replace(text, shapes, "");
  const size_t robot = text.find("<robot");
  const bool on_world = text.find("link=\"world\"") != std::string::npos &&
                        text.find("<link name=\"world\"") == std::string::npos;
  return text.insert(
      text.find('>', robot) + 1,
      std::string(on_world ? "<link name=\"world\"/>" : "") +
          "<mujoco><compiler balanceinertia=\"true\" fusestatic=\"false\"/></mujoco>");
}

/// MuJoCo counts volumes of meshes that are not convex too large unless it is told not to: the mug
/// with its mesh beside it, told so. Other files as they are.
std::string with_exact_meshes(const std::string& file, const ScratchFolder& scratch) {
  if (!file.ends_with("mug.xml")) return file;
  const std::string folder = file.substr(0, file.rfind('/') + 1);
  for (const char* name : {"mug.obj", "mug.png"}) scratch.write(name, file_text(folder + name));
  std::string text = file_text(file);
  text.insert(text.find('>', text.find("<mujoco")) + 1, "<compiler exactmeshinertia=\"true\"/>");
  return scratch.write("mug.xml", text).string();
}

}  // namespace

TEST_CASE("MuJoCo's samples: masses, places and joints as its own reader has them") {
  const std::string folder = "/usr/share/mujoco/model/";
  const ScratchFolder scratch("mujoco");
  size_t files = 0;
  for (const auto& [name, ticks] :
       {std::pair("adhesion/active_adhesion.xml", 30), std::pair("hammock/hammock.xml", 20),
        std::pair("hammock/humanoid_body.xml", 30), std::pair("humanoid/humanoid.xml", 60),
        std::pair("humanoid/22_humanoids.xml", 3), std::pair("humanoid100/humanoid100.xml", 10),
        std::pair("humanoid100/humanoid_body.xml", 30), std::pair("mug/mug.xml", 30),
        std::pair("slider_crank/slider_crank.xml", 30), std::pair("tendon_arm/arm26.xml", 30)}) {
    const std::string file = folder + name;
    CAPTURE(file);
    const MujocoModel other = read_by_mujoco(with_exact_meshes(file, scratch));
    REQUIRE_MESSAGE(other.error.empty(), other.error);
    RobotLog log;
    const RobotModel model = read_robot_file(file, {}, log);
    REQUIRE_MESSAGE(log.ok(), all_text(log.faults()));
    const Agreement same = compare(model, other);
    CHECK(same.bodies == model.links.size());
    size_t joints = 0;
    for (const RobotLink& l : model.links) joints += l.joints.size();
    CHECK(same.joints == joints);
    CHECK(same.bodies > 0);
    // The hinges of the arm stand upright: gravity alone moves nothing.
    const bool upright = file.ends_with("arm26.xml");
    step_scene(file, other, ticks,
               upright ? std::vector<std::string>{"settings.gravity=[0, -9.81, -3]"}
                       : std::vector<std::string>{});
    ++files;
  }
  CHECK(files == 10);
}

TEST_CASE("Simbody's URDFs: masses, places and joints as MuJoCo reads them") {
  const std::string folder = "/usr/share/doc/simbody/examples/src/TaskSpaceControl-";
  const ScratchFolder scratch("simbody");
  for (const auto& [name, links, joints] :
       {std::tuple("Atlas/models/atlas_v4", 47, 29),
        std::tuple("Atlas/models/atlas_v4_upper", 36, 17),
        std::tuple("Atlas/models/atlas_v4_robotiq_hands", 73, 53),
        std::tuple("UR10/models/ur10_robot", 9, 6),
        std::tuple("UR10/models/ur10_joint_limited_robot", 9, 6),
        std::tuple("Atlas/models/atlas_v4_free_pelvis", 48, 29),
        std::tuple("Atlas/models/atlas_v4_locked_pelvis", 48, 29)}) {
    const std::string file = folder + name + ".urdf.gz";
    CAPTURE(file);
    RobotLog log;
    const RobotModel model = read_robot_file(file, {}, log);
    REQUIRE_MESSAGE(log.ok(), all_text(log.faults()));
    CHECK(model.links.size() == size_t(links));
    const auto plain = scratch.write("robot.urdf", for_mujoco(unpacked_text(file)));
    const MujocoModel other = read_by_mujoco(plain.string());
    if (!other.error.empty()) {
      MESSAGE(file << ": " << other.error);
      continue;
    }
    const Agreement same = compare(model, other, {"head"});
    CHECK(same.bodies >= size_t(links) - 2);  // but for what MuJoCo makes its world
    CHECK(same.joints == size_t(joints));
    step_scene(file, other, 20);
  }
}
