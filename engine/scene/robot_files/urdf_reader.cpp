#include "engine/scene/robot_files/urdf_reader.hpp"

#include "engine/core/text.hpp"
#include "engine/math/rotation.hpp"
#include "engine/scene/robot_files/attributes.hpp"
#include "engine/scene/robot_files/link_mass.hpp"
#include "engine/scene/robot_files/urdf_link.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace tumble {
namespace {

/// A joint as given by its element, before the tree is built.
struct UrdfJoint {
  std::string parent, child;
  Pose origin;
  std::vector<RobotJoint> coordinates;
  bool floating = false;
  RobotPlace at;
  std::string name;
};

namespace urdf_type {
enum : size_t { revolute, continuous, prismatic, fixed, floating, planar };
}  // namespace urdf_type

void read_limit(const XmlElement& e, size_t type, RobotJoint& joint, RobotLog& log) {
  Attributes a(e, log);
  std::optional<double> lower, upper;
  a.read("lower", lower);
  a.read("upper", upper);
  a.read("effort", joint.effort);
  if (joint.effort && !(*joint.effort >= 0)) {
    a.fault("effort", fmt::format("must not be negative, got {}", *joint.effort));
    joint.effort.reset();
  }
  a.warn_of({"velocity"}, "joints have no greatest speed here");
  if (type == urdf_type::continuous) {
    if (lower || upper)
      log.warn(e.at,
               "<limit>: a continuous joint has no 'lower' and 'upper', they are not followed");
    return;
  }
  joint.lower = lower.value_or(0);
  joint.upper = upper.value_or(0);
  if (*joint.lower > *joint.upper) {
    log.fault(e.at, fmt::format("<limit>: 'lower' {} is above 'upper' {} (exchange them)",
                                *joint.lower, *joint.upper));
    joint.lower = joint.upper;
  }
}

void read_mimic(const XmlElement& e, RobotJoint& joint, RobotLog& log) {
  Attributes a(e, log);
  RobotMimic mimic;
  mimic.joint = a.name_of("joint");
  a.read("multiplier", mimic.multiplier);
  a.read("offset", mimic.offset);
  joint.mimic = std::move(mimic);
}

Vec3 read_axis(const XmlElement* e, RobotLog& log) {
  Vec3 axis(1, 0, 0);
  if (!e) return axis;
  Attributes a(*e, log);
  a.read("xyz", axis);
  if (axis.norm() > 0) return axis.normalized();
  log.fault(e->at, "<axis>: an axis of zeros has no direction");
  return {1, 0, 0};
}

/// Makes the coordinates of a kind of joint: those of `planar` are two translations in the plane
/// and a rotation about its normal.
void make_coordinates(const XmlElement& e, size_t type, UrdfJoint& out, RobotLog& log) {
  if (type == urdf_type::fixed || type == urdf_type::floating) {
    out.floating = type == urdf_type::floating;
    return;
  }
  RobotJoint joint;
  joint.name = out.name;
  joint.at = e.at;
  joint.axis = read_axis(e.find("axis"), log);
  joint.kind = type == urdf_type::prismatic ? RobotJoint::Kind::slide : RobotJoint::Kind::hinge;
  const XmlElement* limit = e.find("limit");
  if (limit && type != urdf_type::planar) read_limit(*limit, type, joint, log);
  if (limit && type == urdf_type::planar)
    log.warn(limit->at, "<limit>: of a planar joint is not followed");
  if (!limit && (type == urdf_type::revolute || type == urdf_type::prismatic))
    log.warn(e.at, fmt::format("joint '{}' has no <limit>, which its type requires: it moves "
                               "without bounds",
                               out.name));
  if (const XmlElement* dynamics = e.find("dynamics")) {
    Attributes a(*dynamics, log);
    a.read("damping", joint.damping);
    a.read("friction", joint.friction);
    if (joint.damping < 0 || joint.friction < 0)
      a.fault("", "damping and friction must not be negative");
    joint.damping = std::max(joint.damping, 0.0);
    joint.friction = std::max(joint.friction, 0.0);
  }
  const XmlElement* mimic = e.find("mimic");
  if (mimic && type == urdf_type::planar)
    log.warn(mimic->at, "<mimic>: a planar joint has more than one coordinate, none follows");
  else if (mimic)
    read_mimic(*mimic, joint, log);
  if (type == urdf_type::planar) {
    Vec3 x, y;
    tangent_frame(joint.axis, x, y);
    for (const auto& [axis, suffix] : {std::pair(x, "_x"), std::pair(y, "_y")}) {
      RobotJoint slide = joint;
      slide.name += suffix;
      slide.kind = RobotJoint::Kind::slide;
      slide.axis = axis;
      out.coordinates.push_back(slide);
    }
  }
  // Zero if the limits allow it, otherwise the nearest value.
  if (joint.lower) joint.start = std::clamp(0.0, *joint.lower, *joint.upper);
  if (joint.start != 0)
    log.warn(e.at, fmt::format("joint '{}' starts at its limit {}, for 0 is beyond it", out.name,
                               joint.start));
  out.coordinates.push_back(std::move(joint));
}

UrdfJoint read_urdf_joint(const XmlElement& e, RobotLog& log) {
  UrdfJoint out;
  out.at = e.at;
  {
    Attributes a(e, log);
    out.name = a.name_of("name");
    if (!a.has("type")) a.fault("", "the attribute 'type' is missing");
    const size_t type =
        a.word("type", {"revolute", "continuous", "prismatic", "fixed", "floating", "planar"});
    make_coordinates(e, type, out, log);
  }
  const auto link = [&](const char* name) -> std::string {
    if (const XmlElement* child = e.find(name)) return Attributes(*child, log).name_of("link");
    log.fault(e.at, fmt::format("joint '{}' has no <{}>", out.name, name));
    return {};
  };
  out.parent = link("parent");
  out.child = link("child");
  for (const XmlElement& child : e.children) {
    if (child.name == "origin") out.origin = read_urdf_origin(child, log);
    const auto known = {"origin", "parent", "child", "axis", "limit", "dynamics", "mimic"};
    if (std::find(known.begin(), known.end(), child.name) == known.end())
      log.warn(child.at, fmt::format("<{}> of a joint is not followed", child.name));
  }
  return out;
}

/// Removes couplings to joints that are fixed or free (floating), which have no coordinate to
/// follow.
void let_go_of_unmoved(std::vector<UrdfJoint>& joints, RobotLog& log) {
  for (UrdfJoint& joint : joints)
    for (RobotJoint& c : joint.coordinates) {
      if (!c.mimic) continue;
      const auto leader = std::ranges::find(joints, c.mimic->joint, &UrdfJoint::name);
      if (leader == joints.end() || !leader->coordinates.empty()) continue;
      log.warn(joint.at,
               fmt::format("joint '{}' does not follow '{}', which is {} and has no "
                           "coordinate: it moves by itself",
                           joint.name, leader->name, leader->floating ? "floating" : "fixed"));
      c.mimic.reset();
    }
}

/// Builds one tree of links and joints, parents first.
class UrdfTree {
 public:
  UrdfTree(std::vector<RobotLink> links, std::vector<UrdfJoint> joints, RobotLog& log)
      : links_(std::move(links)), joints_(std::move(joints)), log_(log) {}

  std::vector<RobotLink> take() {
    for (size_t i = 0; i < links_.size(); ++i)
      if (!by_name_.emplace(links_[i].name, i).second)
        log_.fault(links_[i].at, fmt::format("a second link '{}'", links_[i].name));
    add_world();
    joint_of_.assign(links_.size(), none);
    children_.resize(links_.size());
    for (size_t j = 0; j < joints_.size(); ++j) tie(j);
    if (log_.ok()) grow();
    return std::move(sorted_);
  }

 private:
  static constexpr size_t none = ~size_t{0};

  /// Files may attach links to a link `world` without declaring it.
  void add_world() {
    for (const UrdfJoint& joint : joints_) {
      if (joint.parent != "world" || by_name_.contains("world")) continue;
      RobotLink world;
      world.name = "world";
      world.at = joint.at;
      by_name_.emplace(world.name, links_.size());
      links_.push_back(std::move(world));
    }
  }

  size_t find(const std::string& name, const UrdfJoint& joint) {
    const auto found = by_name_.find(name);
    if (found != by_name_.end()) return found->second;
    std::vector<std::string> names;
    for (const RobotLink& l : links_) names.push_back(l.name);
    if (!name.empty())
      log_.fault(joint.at,
                 fmt::format("joint '{}': {}", joint.name, unknown_name("link", name, names)));
    return none;
  }

  void tie(size_t j) {
    const UrdfJoint& joint = joints_[j];
    for (size_t other = 0; other < j; ++other)
      if (joints_[other].name == joint.name && !joint.name.empty()) {
        log_.fault(joint.at, fmt::format("a second joint '{}'", joint.name));
        break;
      }
    const size_t parent = find(joint.parent, joint), child = find(joint.child, joint);
    if (parent == none || child == none) return;
    if (parent == child)
      return log_.fault(joint.at, fmt::format("joint '{}' hangs link '{}' on itself: parent and "
                                              "child must be two links",
                                              joint.name, joint.child));
    if (joint_of_[child] != none)
      return log_.fault(joint.at,
                        fmt::format("link '{}' hangs on two joints, '{}' and '{}': a URDF is a "
                                    "tree, without loops",
                                    joint.child, joints_[joint_of_[child]].name, joint.name));
    joint_of_[child] = j;
    children_[parent].push_back(child);
  }

  void grow() {
    size_t root = none;
    for (size_t i = 0; i < links_.size(); ++i) {
      if (joint_of_[i] != none) continue;
      if (root != none)
        return log_.fault(links_[i].at,
                          fmt::format("both '{}' and '{}' hang on no joint: a URDF is one tree",
                                      links_[root].name, links_[i].name));
      root = i;
    }
    if (root == none)
      return log_.fault(links_.front().at, "every link hangs on another: there is no base");
    std::vector<std::pair<size_t, size_t>> waiting{{root, RobotLink::world}};
    for (size_t next = 0; next < waiting.size(); ++next) {
      const auto [i, parent] = waiting[next];
      RobotLink link = std::move(links_[i]);
      link.parent = parent;
      if (joint_of_[i] != none) {
        UrdfJoint& joint = joints_[joint_of_[i]];
        link.in_parent = joint.origin;
        link.joints = std::move(joint.coordinates);
        link.floating = joint.floating;
      }
      sorted_.push_back(std::move(link));
      for (const size_t child : children_[i]) waiting.emplace_back(child, next);
    }
    if (sorted_.size() == links_.size()) return;
    for (const RobotLink& link : links_)
      if (!link.name.empty())
        return log_.fault(link.at, fmt::format("link '{}' is part of a loop of joints", link.name));
  }

  std::vector<RobotLink> links_, sorted_;
  std::vector<UrdfJoint> joints_;
  RobotLog& log_;
  std::map<std::string, size_t> by_name_;
  std::vector<size_t> joint_of_;
  std::vector<std::vector<size_t>> children_;
};

}  // namespace

RobotModel read_urdf(const XmlElement& root, const std::filesystem::path& file,
                     const PackageFolders& packages, RobotLog& log) {
  RobotModel out;
  out.file = file;
  {
    Attributes a(root, log);
    out.name = a.text("name").value_or("robot");
    const std::string version = a.text("version").value_or("1.0");
    if (version != "1.0" && version != "1.1" && version != "1.2" && version != "1")
      log.warn(root.at, fmt::format("version {} of URDF is read as 1.2", version));
    a.skip({"xmlns:xacro", "xmlns"});
  }
  UrdfMaterials materials;
  for (const XmlElement& e : root.children) {
    if (e.name.starts_with("xacro:")) {
      log.fault(e.at, fmt::format("<{}>: this is a xacro file; make a URDF of it: xacro {} > "
                                  "robot.urdf",
                                  e.name, file.filename().string()));
      return out;
    }
    if (e.name == "material") materials.add(e, log);
  }
  std::vector<RobotLink> links;
  std::vector<UrdfJoint> joints;
  const UrdfFiles files{file, packages};
  for (const XmlElement& e : root.children) {
    if (e.name == "link")
      links.push_back(read_urdf_link(e, materials, files, log));
    else if (e.name == "joint")
      joints.push_back(read_urdf_joint(e, log));
    else if (e.name != "material")
      log.warn(e.at,
               fmt::format("<{}> is not followed: it is not of the robot's mechanics", e.name));
  }
  if (links.empty()) {
    log.fault(root.at, "has no <link>");
    return out;
  }
  let_go_of_unmoved(joints, log);
  out.links = UrdfTree(std::move(links), std::move(joints), log).take();
  return out;
}

}  // namespace tumble
