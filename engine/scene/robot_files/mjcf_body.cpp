#include "engine/scene/robot_files/mjcf_body.hpp"

#include "engine/scene/robot_files/link_mass.hpp"
#include "engine/scene/robot_files/mjcf_geom.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Why an element that is known but not supported is ignored.
std::string reason_not_read(const std::string& element) {
  if (element == "site") return "<site> is not followed: a marked place without mechanics";
  if (element == "camera" || element == "light")
    return fmt::format("<{}> is not followed: the scene has its own", element);
  if (element == "composite" || element == "flexcomp" || element == "replicate")
    return fmt::format("<{}> is not made: the bodies that it stands for are missing", element);
  return fmt::format("<{}> is not followed", element);
}

class MjcfBodies {
 public:
  MjcfBodies(const MjcfSettings& settings, RobotModel& out, RobotLog& log)
      : s_(settings), out_(out), log_(log) {
    for (const RobotLink& link : out_.links) names_.insert(link.name);
  }

  /// Reads the children of a body, or of the world, in its frame.
  void children(const XmlElement& e, size_t link, const std::string& body_class, const Pose& at) {
    for (const XmlElement& child : e.children) {
      if (child.name == "geom")
        geom(child, link, body_class, at);
      else if (child.name == "body")
        body(child, link, body_class, at);
      else if (child.name == "frame")
        frame(child, link, body_class, at);
      else if (link == RobotLink::world)
        log_.warn(child.at, reason_not_read(child.name));
      else if (child.name == "joint" || child.name == "freejoint")
        joint(child, link, body_class, at);
      else if (child.name == "inertial")
        inertial(child, link);
      else
        log_.warn(child.at, reason_not_read(child.name));
    }
  }

 private:
  struct Parts {
    std::vector<MassProperties> geoms;
    bool has_inertial = false;
    GivenInertia given;
    bool tied = false;  ///< a joint of its own has been read
  };

  void frame(const XmlElement& e, size_t link, std::string body_class, const Pose& at) {
    Pose here;
    {
      Attributes a(e, log_);
      here = at * s_.read_pose(a);
      a.read("childclass", body_class);
      a.skip({"name"});
    }
    children(e, link, body_class, here);
  }

  void body(const XmlElement& e, size_t parent, std::string body_class, const Pose& at) {
    RobotLink link;
    link.at = e.at;
    link.parent = parent;
    {
      Attributes a(e, log_);
      link.in_parent = at * s_.read_pose(a);
      a.read("childclass", body_class);
      link.name = a.text("name").value_or("");
      bool moved = false;
      a.read("mocap", moved);
      if (moved) log_.warn(e.at, "<body>: a mocap body stands where it is");
      a.skip({"user"});
    }
    if (link.name.empty()) link.name = fmt::format("body_{}", out_.links.size() + 1);
    if (!names_.insert(link.name).second)
      log_.fault(e.at, fmt::format("a second body '{}'", link.name));
    const size_t index = out_.links.size();
    out_.links.push_back(std::move(link));
    parts_.resize(out_.links.size());
    children(e, index, body_class, {});
    weigh(index);
  }

  void geom(const XmlElement& e, size_t link, const std::string& body_class, const Pose& at) {
    auto geom = read_mjcf_geom(e, body_class, s_, log_);
    if (!geom) return;
    geom->geometry.pose = at * geom->geometry.pose;
    if (geom->mass) geom->mass = moved(*geom->mass, at);
    if (link == RobotLink::world) {
      if (geom->collides) return out_.scenery.push_back(geom->geometry);
      return log_.warn(e.at, "<geom>: scenery without collision is not drawn");
    }
    if (geom->mass) parts_[link].geoms.push_back(*geom->mass);
    RobotLink& to = out_.links[link];
    if (geom->collides) to.collides.push_back(geom->geometry);
    if (geom->drawn) to.drawn.push_back(std::move(geom->geometry));
  }

  void inertial(const XmlElement& e, size_t link) {
    Attributes a(e, log_);
    const Pose at = s_.read_pose(a);
    Parts& parts = parts_[link];
    parts.has_inertial = true;
    MassProperties& m = out_.links[link].mass;
    if (!a.has("mass")) a.fault("", "the attribute 'mass' is missing");
    a.read("mass", m.mass);
    if (m.mass < 0) a.fault("mass", "a mass must not be negative");
    m.centre = at.x;
    parts.given.at = e.at;
    Vec3 diagonal = Vec3::Zero();
    if (a.has("diaginertia")) {
      a.read("diaginertia", diagonal);
      parts.given.tensor = diagonal.asDiagonal();
    }
    if (const auto v = a.numbers("fullinertia", 6, 6); !v.empty())
      parts.given.tensor = Mat3(v[0], v[3], v[4], v[3], v[1], v[5], v[4], v[5], v[2]);
    if (!parts.given.tensor) return;
    const Mat3 R = at.q.toRotationMatrix();
    parts.given.tensor = R * *parts.given.tensor * R.transpose();
  }

  void joint(const XmlElement& e, size_t index, const std::string& body_class, const Pose& at) {
    Attributes a(e, log_);
    RobotLink& link = out_.links[index];
    const bool free_element = e.name == "freejoint";
    if (!free_element) s_.set_defaults(a, "joint", body_class, log_);
    const size_t type = free_element ? 3 : a.word("type", {"hinge", "slide", "ball", "free"});
    RobotJoint joint;
    joint.at = e.at;
    joint.name = a.text("name").value_or("");
    a.skip({"group", "user", "align"});
    if (link.floating || (type == 3 && parts_[index].tied))
      return a.fault("", "a free joint must be the only joint of its body");
    parts_[index].tied = true;
    if (type == 3) {
      a.skip({"pos", "axis", "range", "limited"});
      if (link.parent != RobotLink::world)
        a.fault("", "only a body of the world can have a free joint");
      link.floating = true;
      return;
    }
    if (joint.name.empty())
      joint.name =
          fmt::format("{}_joint{}", link.name,
                      link.joints.empty() ? "" : fmt::format("_{}", link.joints.size() + 1));
    joint.kind =
        std::array{RobotJoint::Kind::hinge, RobotJoint::Kind::slide, RobotJoint::Kind::ball}[type];
    a.read("pos", joint.anchor);
    joint.anchor = at.point(joint.anchor);
    a.read("axis", joint.axis);
    if (!(joint.axis.norm() > 0)) {
      if (type != 2) a.fault("axis", "an axis of zeros has no direction");
      joint.axis = Vec3::UnitZ();
    }
    joint.axis = at.direction(joint.axis.normalized());
    motion(a, type, joint);
    link.joints.push_back(std::move(joint));
  }

  /// Reads range, springs and friction.
  void motion(Attributes& a, size_t type, RobotJoint& joint) {
    const double unit = type == 1 ? 1 : s_.angle;
    const auto range = a.numbers("range", 2, 2);
    const size_t limited = a.word("limited", {"auto", "true", "false", "1", "0"});
    const bool bounded =
        !range.empty() && (limited == 1 || limited == 3 || (limited == 0 && s_.autolimits));
    if (bounded && type == 2) {
      a.warn_of({"range"}, "balls turn without bounds here");
    } else if (bounded) {
      joint.lower = unit * range[0];
      joint.upper = unit * range[1];
      if (range[0] > range[1]) a.fault("range", "its first number is above its second");
    }
    a.read("damping", joint.damping);
    a.read("stiffness", joint.stiffness);
    a.read("frictionloss", joint.friction);
    a.read("armature", joint.armature);
    a.read("ref", joint.reference);
    a.read("springref", joint.rest);
    if (type == 2)
      a.warn_of({"damping", "stiffness", "frictionloss", "armature"}, "of balls nothing acts");
    for (double* value : {&joint.damping, &joint.stiffness, &joint.friction, &joint.armature}) {
      if (*value < 0)
        a.fault("", "damping, stiffness, frictionloss and armature must not be negative");
      *value = type == 2 ? 0 : std::max(*value, 0.0);
    }
    joint.reference *= type == 2 ? 0 : unit;
    joint.rest *= unit;
    joint.start = joint.reference;
  }

  void weigh(size_t index) {
    RobotLink& link = out_.links[index];
    Parts& parts = parts_[index];
    const bool own = s_.inertia == MjcfInertia::inertial ||
                     (s_.inertia == MjcfInertia::automatic && parts.has_inertial);
    if (!own) {
      link.mass = compound(parts.geoms);
      parts.given.at = link.at;
      parts.given.tensor = link.mass.inertia;
    }
    if (link.mass.mass > 0) link.mass.mass = std::max(link.mass.mass, s_.least_mass);
    complete_mass(link, parts.given, log_);
    if (link.mass.mass > 0 && s_.least_inertia > 0)
      for (int k = 0; k < 3; ++k)
        link.mass.inertia(k, k) = std::max(link.mass.inertia(k, k), s_.least_inertia);
  }

  const MjcfSettings& s_;
  RobotModel& out_;
  RobotLog& log_;
  std::vector<Parts> parts_ = std::vector<Parts>(out_.links.size());
  std::set<std::string> names_;
};

}  // namespace

void read_mjcf_world(const XmlElement& e, const MjcfSettings& settings, RobotModel& out,
                     RobotLog& log) {
  MjcfBodies(settings, out, log).children(e, RobotLink::world, mjcf_main_class, {});
}

}  // namespace tumble
