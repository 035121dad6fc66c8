#include "engine/scene/robot_files/mjcf_reader.hpp"

#include "engine/core/text.hpp"
#include "engine/scene/robot_files/mjcf_body.hpp"
#include "engine/scene/robot_files/mjcf_settings.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Replaces <include> elements by the content of their files, whose paths are relative to the main
/// file.
void include_files(XmlElement& e, const std::filesystem::path& main, int depth, RobotLog& log) {
  constexpr int deepest = 8;
  std::vector<XmlElement> children;
  for (XmlElement& child : e.children) {
    if (child.name != "include") {
      include_files(child, main, depth, log);
      children.push_back(std::move(child));
      continue;
    }
    const std::string name = Attributes(child, log).name_of("file");
    if (depth >= deepest) {
      log.fault(child.at,
                fmt::format("<include> is nested deeper than {}: does '{}' include itself?",
                            deepest, name));
      return;
    }
    if (name.empty()) continue;
    RobotLog of_file;
    auto root = read_xml(main.parent_path() / name, of_file);
    for (const Fault& f : of_file.faults())
      log.fault(child.at, fmt::format("<include>: {}", f.text()));
    if (!root) continue;
    include_files(*root, main, depth + 1, log);
    for (XmlElement& part : root->children) children.push_back(std::move(part));
  }
  e.children = std::move(children);
}

class MjcfRest {
 public:
  MjcfRest(const MjcfSettings& settings, RobotModel& out, RobotLog& log)
      : s_(settings), out_(out), log_(log) {}

  void option(const XmlElement& e) {
    Vec3 gravity = out_.gravity.value_or(Vec3(0, 0, -9.81));
    {
      Attributes a(e, log_);
      a.read("gravity", gravity);
      a.warn_of({"timestep"}, "the scene has its own tick (settings.tick_hz)");
      a.warn_of({"wind", "density", "viscosity"}, "nothing flows about the bodies");
      a.warn_of({"integrator", "solver", "iterations", "tolerance", "cone", "jacobian",
                 "noslip_iterations", "impratio", "collision", "apirate"},
                "of its own solver");
    }
    for (const XmlElement& child : e.children) {
      Attributes a(child, log_);
      if (child.name == "flag" && a.text("gravity").value_or("") == "disable")
        gravity = Vec3::Zero();
    }
    out_.gravity = gravity;
  }

  void actuator(const XmlElement& e) {
    const bool known = e.name == "motor" || e.name == "position" || e.name == "velocity";
    if (!known)
      return log_.warn(e.at, fmt::format("<{}> is no actuator that is made: motor, position and "
                                         "velocity are",
                                         e.name));
    Attributes a(e, log_);
    s_.set_defaults(a, e.name, mjcf_main_class, log_);
    a.skip({"name", "group", "user"});
    const auto name = a.has("joint") ? a.text("joint") : a.text("jointinparent");
    if (!name)
      return log_.warn(e.at,
                       fmt::format("<{}> drives no joint (but a tendon, site, body or crank): "
                                   "it is not made",
                                   e.name));
    RobotJoint* joint = find_joint(*name, e.at);
    if (!joint) return;
    drive(a, e.name, *joint);
  }

  void equality(const XmlElement& e) {
    Attributes a(e, log_);
    s_.set_defaults(a, "equality", mjcf_main_class, log_);
    bool active = true;
    a.read("active", active);
    RobotTie tie;
    tie.at = e.at;
    tie.name = a.text("name").value_or("");
    if (e.name == "joint") return follow(e, a, active);
    if (e.name != "connect" && e.name != "weld") {
      if (active)
        log_.warn(e.at, fmt::format("<{}> of <equality> is not followed: its parts move by "
                                    "themselves",
                                    e.name));
      return a.skip({"joint1", "joint2", "polycoef", "tendon1", "tendon2", "geom1", "geom2"});
    }
    if (a.has("site1") || a.has("site2"))
      return log_.warn(e.at, fmt::format("<{}> between sites is not made", e.name));
    tie.kind = e.name == "connect" ? RobotTie::Kind::point : RobotTie::Kind::weld;
    tie.a = find_link(a.name_of("body1"), e.at);
    if (const auto other = a.text("body2")) tie.b = find_link(*other, e.at);
    if (e.name == "connect") {
      if (!a.has("anchor")) a.fault("", "the attribute 'anchor' is missing");
      a.read("anchor", tie.anchor);
    } else {
      a.warn_of({"relpose"}, "they are welded as they stand at the start");
    }
    if (active && log_.ok()) out_.ties.push_back(std::move(tie));
  }

  /// Reads a coupling y - y_ref = a_0 + a_1 (x - x_ref), with y of joint1 and x of joint2.
  void follow(const XmlElement& e, Attributes& a, bool active) {
    RobotJoint* y = find_joint(a.name_of("joint1"), e.at);
    const auto other = a.text("joint2");
    std::vector<double> c = a.numbers("polycoef", 1, 5);
    if (c.empty()) c = {0, 1};
    c.resize(5);
    if (!active || !y) return;
    if (!other || c[2] != 0 || c[3] != 0 || c[4] != 0)
      return log_.warn(e.at, fmt::format("<joint> of <equality>: '{}' moves by itself; only a "
                                         "linear relation of two joints is followed",
                                         y->name));
    const RobotJoint* x = find_joint(*other, e.at);
    if (x) y->mimic = RobotMimic{x->name, c[1], c[0] + y->reference - c[1] * x->reference};
  }

  void contact(const XmlElement& e) {
    Attributes a(e, log_);
    if (e.name != "exclude") return log_.warn(e.at, fmt::format("<{}> is not followed", e.name));
    RobotTie tie;
    tie.at = e.at;
    tie.kind = RobotTie::Kind::apart;
    tie.name = a.text("name").value_or("");
    tie.a = find_link(a.name_of("body1"), e.at);
    tie.b = find_link(a.name_of("body2"), e.at);
    if (log_.ok()) out_.ties.push_back(std::move(tie));
  }

 private:
  size_t find_link(const std::string& name, const RobotPlace& at) {
    if (name == "world") return RobotLink::world;
    std::vector<std::string> names;
    for (size_t i = 0; i < out_.links.size(); ++i) {
      if (out_.links[i].name == name) return i;
      names.push_back(out_.links[i].name);
    }
    if (!name.empty()) log_.fault(at, unknown_name("body", name, names));
    return RobotLink::world;
  }

  RobotJoint* find_joint(const std::string& name, const RobotPlace& at) {
    std::vector<std::string> names;
    for (RobotLink& link : out_.links)
      for (RobotJoint& joint : link.joints) {
        if (joint.name == name) return &joint;
        names.push_back(joint.name);
      }
    log_.fault(at, unknown_name("joint", name, names));
    return nullptr;
  }

  /// A range that is given and enabled.
  std::vector<double> range(Attributes& a, const char* name, const char* switched) {
    const auto out = a.numbers(name, 2, 2);
    const size_t limited = a.word(switched, {"auto", "true", "false", "1", "0"});
    const bool on = limited == 1 || limited == 3 || (limited == 0 && s_.autolimits);
    return on ? out : std::vector<double>{};
  }

  /// Sets the actuator's state at control 0: a position servo holds 0, a velocity servo brakes, a
  /// motor does nothing.
  void drive(Attributes& a, const std::string& kind, RobotJoint& joint) {
    if (joint.kind == RobotJoint::Kind::ball) {
      a.skip({"gear", "ctrlrange", "ctrllimited", "forcerange", "forcelimited", "kp", "kv"});
      return log_.warn(a.at(),
                       fmt::format("<{}>: of ball '{}' nothing is driven", kind, joint.name));
    }
    const auto gears = a.numbers("gear", 1, 6);
    const double gear = gears.empty() ? 1 : gears[0];
    const auto control = range(a, "ctrlrange", "ctrllimited");
    const auto force = range(a, "forcerange", "forcelimited");
    double kp = 1, kv = kind == "velocity" ? 1 : 0;
    if (kind == "position") a.read("kp", kp);
    if (kind != "motor") a.read("kv", kv);
    const double held = control.empty() ? 0
                                        : std::clamp(0.0, std::min(control[0], control[1]),
                                                     std::max(control[0], control[1]));
    RobotActuator made;
    if (!force.empty())
      made.max_force = std::fabs(gear) * std::max(std::fabs(force[0]), std::fabs(force[1]));
    made.damping = std::max(0.0, kv) * gear * gear;
    if (kind == "motor") {
      made.target = gear * held;
      if (!control.empty())
        made.max_force = std::fabs(gear) * std::max(std::fabs(control[0]), std::fabs(control[1]));
    } else if (kind == "position") {
      made.kind = RobotActuator::Kind::position;
      made.stiffness = std::max(0.0, kp) * gear * gear;
      made.target = gear != 0 ? held / gear : 0;
    } else {
      made.kind = RobotActuator::Kind::damper;
      if (held != 0) a.warn_of({"ctrlrange"}, "the control is 0");
      if (made.max_force) a.warn_of({"forcerange"}, "it brakes with whatever force that takes");
    }
    if (!joint.actuator) {
      joint.actuator = made;
    } else if (joint.actuator->kind != made.kind && made.kind != RobotActuator::Kind::force &&
               joint.actuator->kind != RobotActuator::Kind::force) {
      // A position servo and a velocity servo together are one actuator with both gains.
      const double damping = joint.actuator->damping + made.damping;
      if (made.kind == RobotActuator::Kind::position) joint.actuator = made;
      joint.actuator->damping = damping;
    } else {
      log_.warn(a.at(), fmt::format("<{}>: joint '{}' is driven already, only by the first", kind,
                                    joint.name));
    }
  }

  const MjcfSettings& s_;
  RobotModel& out_;
  RobotLog& log_;
};

void scale_masses(RobotModel& model, double total) {
  double sum = 0;
  for (const RobotLink& link : model.links) sum += link.mass.mass;
  if (!(sum > 0)) return;
  for (RobotLink& link : model.links) link.mass = link.mass.times(total / sum);
}

void check_joint_names(const RobotModel& model, RobotLog& log) {
  std::vector<std::pair<std::string, RobotPlace>> names;
  for (const RobotLink& link : model.links)
    for (const RobotJoint& joint : link.joints) names.emplace_back(joint.name, joint.at);
  std::stable_sort(names.begin(), names.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (size_t i = 1; i < names.size(); ++i)
    if (names[i].first == names[i - 1].first)
      log.fault(names[i].second, fmt::format("a second joint '{}'", names[i].first));
}

std::string reason_of(const std::string& part) {
  if (part == "size" || part == "visual" || part == "statistic")
    return fmt::format("<{}> is not followed: it is of its own program", part);
  if (part == "sensor") return "<sensor> is not read: joints and bodies have readings of their own";
  if (part == "keyframe") return "<keyframe> is not read: the robot starts as its bodies stand";
  return fmt::format("<{}> is not read", part);
}

}  // namespace

RobotModel read_mjcf(const XmlElement& given, const std::filesystem::path& file, RobotLog& log) {
  RobotModel out;
  out.file = file;
  out.gravity = Vec3(0, 0, -9.81);
  XmlElement root = given;
  include_files(root, file, 0, log);
  {
    Attributes a(root, log);
    out.name = a.text("model").value_or(file.stem().string());
  }
  MjcfSettings settings(file);
  settings.read(root, log);
  for (const XmlElement& e : root.children)
    if (e.name == "worldbody") read_mjcf_world(e, settings, out, log);
  check_joint_names(out, log);
  MjcfRest rest(settings, out, log);
  for (const XmlElement& e : root.children) {
    const auto known = {"compiler", "default", "asset", "worldbody"};
    if (std::find(known.begin(), known.end(), e.name) != known.end()) continue;
    if (e.name == "option") {
      rest.option(e);
    } else if (e.name == "actuator" || e.name == "equality" || e.name == "contact") {
      for (const XmlElement& child : e.children) {
        if (e.name == "actuator") rest.actuator(child);
        if (e.name == "equality") rest.equality(child);
        if (e.name == "contact") rest.contact(child);
      }
    } else if (e.name == "tendon") {
      for (const XmlElement& child : e.children)
        log.warn(child.at, fmt::format("<{}>: tendons are not made", child.name));
    } else {
      log.warn(e.at, reason_of(e.name));
    }
  }
  if (settings.total_mass) scale_masses(out, *settings.total_mass);
  if (out.links.empty() && out.scenery.empty() && log.ok())
    log.fault(root.at, "has no body and no geom");
  return out;
}

}  // namespace tumble
