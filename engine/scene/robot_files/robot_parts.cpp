#include "engine/scene/robot_files/robot_parts.hpp"

#include "engine/core/text.hpp"
#include "engine/math/rotation.hpp"
#include "engine/scene/robot_files/body_parts.hpp"
#include "engine/scene/robot_files/followers.hpp"
#include "engine/scene/robot_files/joint_series.hpp"
#include "engine/scene/robot_files/mjcf_reader.hpp"
#include "engine/scene/robot_files/robot_bodies.hpp"
#include "engine/scene/robot_files/start_overlaps.hpp"
#include "engine/scene/robot_files/urdf_reader.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <set>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Share of a link's mass and inertia for an auxiliary body between two of its joints [-]: small
/// compared with the link, but not so small that the joints are ill-conditioned.
constexpr double between_share = 0.05;
/// Natural frequency of a motor that holds a joint, critically damped [Hz].
constexpr double holding_frequency = 4;
constexpr double half_turn = 180;  // [deg]

/// Sets values of coordinates by the names of joints. Faults: unknown names.
template <class Set>
void set_coordinates(RobotModel& model, std::map<std::string, double> waiting, RobotLog& log,
                     const Set& set) {
  std::vector<std::string> names;
  for (RobotLink& link : model.links)
    for (RobotJoint& joint : link.joints) {
      names.push_back(joint.name);
      const auto given = waiting.find(joint.name);
      if (given == waiting.end()) continue;
      set(joint, given->second);
      waiting.erase(given);
    }
  for (const auto& item : waiting)
    log.fault({std::make_shared<const std::string>(model.file.string()), 0},
              unknown_name("joint", item.first, names));
}

void set_starts(RobotModel& model, const RobotOptions& options, RobotLog& log) {
  set_coordinates(model, options.target, log,
                  [](RobotJoint& joint, double value) { joint.target = value; });
  set_coordinates(model, options.start, log, [&log](RobotJoint& joint, double value) {
    joint.start = value;
    if ((joint.lower && value < *joint.lower) || (joint.upper && value > *joint.upper))
      log.fault(joint.at, fmt::format("joint '{}' cannot start at {:.6g}: its limits are {:.6g} "
                                      "and {:.6g}",
                                      joint.name, value, joint.lower.value_or(-INFINITY),
                                      joint.upper.value_or(INFINITY)));
    if (joint.mimic)
      log.fault(joint.at, fmt::format("joint '{}' follows '{}': say where that one starts",
                                      joint.name, joint.mimic->joint));
  });
  start_followers(model, log);
}

/// For each body, the mass properties of it and everything attached to it (outboard), in the file's
/// world.
std::vector<MassProperties> outboard_masses(const std::vector<RobotBody>& bodies) {
  std::vector<MassProperties> out;
  for (const RobotBody& b : bodies)
    out.push_back(b.mass.mass > 0 ? moved(b.mass, b.start) : MassProperties{});
  for (size_t i = bodies.size(); i-- > 0;) {
    const size_t parent = bodies[i].parent;
    if (parent == RobotLink::world || bodies[i].floating || !(out[i].mass > 0)) continue;
    out[parent] = compound(std::array{out[parent], out[i]});
  }
  return out;
}

class RobotMaker {
 public:
  RobotMaker(const RobotOptions& options, RobotLog& log) : o_(options), log_(log) {}

  RobotParts take(const RobotModel& model) {
    robot_ = join_welded(model, o_.base, log_);
    outboard_ = outboard_masses(robot_.bodies);
    stages_.resize(robot_.bodies.size());
    for (const RobotGeometry& g : model.scenery) scenery(g);
    for (size_t b = 0; b < robot_.bodies.size(); ++b) add_body(b);
    for (size_t b = 0; b < robot_.bodies.size(); ++b) add_joints(b);
    followers_.couple(out_.scene.joints, log_);
    for (const RobotTie& tie : model.ties) add_tie(tie);
    if (o_.self_collision) keep_apart();
    return std::move(out_);
  }

 private:
  Pose world() const { return o_.pose * z_up(); }

  /// A valid name that no other part of its kind in the scene has.
  std::string name_for(const std::string& given, const std::string& list, const RobotPlace& at) {
    constexpr size_t longest = 60;
    std::string name = o_.prefix;
    for (const char c : given)
      name += (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ? c : '_';
    if (name.empty() || (name[0] >= '0' && name[0] <= '9')) name = "_" + name;
    name.resize(std::min(name.size(), longest));
    std::string unique = name;
    for (int n = 2; !names_.insert(list + unique).second; ++n)
      unique = fmt::format("{}_{}", name.substr(0, longest - 6), n);
    if (at.line > 0) out_.lines[list + unique] = at.line;
    return unique;
  }

  void scenery(const RobotGeometry& g) {
    RobotBody body;
    body.at = g.at;
    body.name = "scenery";
    body.collides = {g};
    body.fixed = true;
    out_.has_ground |= is_plane(g);
    BodyDescription& made = describe(body, {});
    made.type = BodyType::fixed;
  }

  BodyDescription& describe(const RobotBody& body, const Pose& start) {
    const std::string name =
        name_for(body.name.empty() ? "between" : body.name, "bodies.", body.at);
    RobotLog ignored;
    BodyDescription made =
        body_of(body, o_.prefix, out_.scene.meshes, body.name.empty() ? ignored : log_);
    const Pose pose = world() * start;
    made.placement.position = pose.x;
    made.placement.orientation = pose.q.normalized();
    for (const RobotGeometry& g : seen_of(body))
      if (const Aabb box = bounds_of(g, pose); !box.empty()) out_.bounds.include(box);
    return out_.scene.bodies.add(name, std::move(made));
  }

  void add_body(size_t index) {
    RobotBody& body = robot_.bodies[index];
    body_names_.emplace_back();
    // A fixed body without geometry is replaced by the world itself.
    if (body.fixed && body.collides.empty() && body.drawn.empty()) return;
    stages_[index] = joint_stages(body.joints);
    const size_t between = stages_[index].empty() ? 0 : stages_[index].size() - 1;
    RobotBody link = body;
    link.mass = body.mass.times(1 - double(between) * between_share);
    BodyDescription& made = describe(link, body.start);
    if (body.fixed) made.type = BodyType::fixed;
    made.precise = !body.joints.empty() || has_children(index);
    if (!o_.self_collision) made.group = o_.group;
    body_names_[index] = out_.scene.bodies.items.back().name;
    if (between > 0)
      log_.warn(body.at,
                fmt::format("'{}' has {} coordinates that make no joint of one kind: "
                            "between its {} joints stand bodies with {:.0f} % of its mass",
                            body.name, body.joints.size(), between + 1, 100 * between_share));
  }

  bool has_children(size_t index) const {
    for (const RobotBody& b : robot_.bodies)
      if (b.parent == index && !b.floating) return true;
    return false;
  }

  /// An auxiliary body between two joints, at the pose of the link after the first of them.
  std::string body_between(const RobotBody& body, const Pose& start) {
    RobotBody made;
    made.at = body.at;
    made.mass = body.mass.times(between_share);
    BodyDescription& d = describe(made, start);
    d.precise = true;
    d.drawn.clear();
    d.look.visible = false;
    return out_.scene.bodies.items.back().name;
  }

  void add_joints(size_t index) {
    const RobotBody& body = robot_.bodies[index];
    if (body.joints.empty()) return;
    const bool in_world = body.parent == RobotLink::world || body_names_[body.parent].empty();
    const Pose parent = body.parent == RobotLink::world ? Pose{} : robot_.bodies[body.parent].start;
    std::string a = in_world ? "" : body_names_[body.parent];
    // The frame of a, and that of the link before a stage, in the file's world.
    Pose of_a = in_world ? world().inverse() : parent;
    Pose before = parent * body.in_parent;
    const auto& stages = stages_[index];
    for (size_t s = 0; s < stages.size(); ++s) {
      Pose after = before;
      for (const size_t c : stages[s].coordinates) after = after * displacement(body.joints[c]);
      const bool last = s + 1 == stages.size();
      const std::string b = last ? body_names_[index] : body_between(body, after);
      add_joint(body, stages[s], a, b, of_a, before, outboard_[index]);
      a = b;
      of_a = before = after;
    }
    if (stages.size() > 1 && !in_world && o_.self_collision)
      apart(body_names_[body.parent], body_names_[index], body.at);
  }

  void add_joint(const RobotBody& body, const JointStage& stage, const std::string& a,
                 const std::string& b, const Pose& of_a, const Pose& before,
                 const MassProperties& outboard) {
    const Pose in_a = of_a.inverse() * before;
    JointDescription made;
    made.kind = stage.kind;
    made.a = a;
    made.b = b;
    made.anchor = in_a.point(stage.anchor);
    made.axis = in_a.direction(stage.axis);
    if (stage.kind == JointKind::universal) made.axis_b = in_a.direction(stage.axis_b);
    const RobotJoint& first = body.joints[stage.coordinates.front()];
    const std::string name = name_for(first.name, "joints.", first.at);
    for (size_t k = 0; k < stage.coordinates.size(); ++k) {
      const RobotJoint& given = body.joints[stage.coordinates[k]];
      RobotJoint joint = given;
      if (stage.names.size() == 1) set_start(joint, made);
      if (stage.names.size() == 1 || !stage.names[k].empty())
        followers_.put(given, {name, stage.names[k], given.start - joint.start});
      const DriveDescription drive = drive_of_joint(joint, gains(joint, before, outboard));
      if (drive.empty()) continue;
      if (stage.names[k].empty()) made.drive = drive;
      JointDescription::for_drives(made, [&](std::string_view name, auto& slot) {
        if (name == stage.names[k]) slot = drive;
      });
    }
    out_.scene.joints.add(name, std::move(made));
  }

  /// Sets the coordinate at the start. Angles beyond half a turn are counted relative to the start.
  static void set_start(RobotJoint& joint, JointDescription& made) {
    if (joint.start == 0) return;
    if (joint.kind == RobotJoint::Kind::slide) {
      made.start = joint.start;
      return;
    }
    const double degrees = joint.start * half_turn / std::numbers::pi;
    if (std::fabs(degrees) <= half_turn) {
      made.start_deg = degrees;
      return;
    }
    for (std::optional<double>* value : {&joint.lower, &joint.upper, &joint.target})
      if (*value) **value -= joint.start;
    joint.rest -= joint.start;
    if (joint.actuator) joint.actuator->target -= joint.start;
    joint.start = 0;
  }

  std::optional<HoldingGains> gains(const RobotJoint& joint, const Pose& before,
                                    const MassProperties& outboard) const {
    if (o_.motors == RobotMotors::file || joint.actuator || joint.mimic ||
        !(joint.effort.value_or(0) > 0))
      return std::nullopt;
    const Vec3 axis = before.direction(joint.axis);
    double inertia = outboard.mass;
    if (joint.kind == RobotJoint::Kind::hinge)
      inertia = axis.dot(inertia_about(outboard, before.point(joint.anchor)) * axis);
    inertia += joint.armature;
    const double rate = 2 * std::numbers::pi * holding_frequency;
    return HoldingGains{inertia * rate * rate, 2 * inertia * rate};
  }

  std::string body_name(size_t link) const {
    if (link == RobotLink::world) return {};
    const size_t body = robot_.links[link].body;
    return body == RobotLink::world ? std::string() : body_names_[body];
  }

  void add_tie(const RobotTie& tie) {
    std::string a = body_name(tie.a), b = body_name(tie.b);
    if (a == b) return log_.warn(tie.at, "ties a body to itself: it is not made");
    if (tie.kind == RobotTie::Kind::apart) return apart(a, b, tie.at);
    JointDescription made;
    made.kind = tie.kind == RobotTie::Kind::point ? JointKind::spherical : JointKind::rigid;
    const LinkPlace of_a = tie.a == RobotLink::world ? LinkPlace{} : robot_.links[tie.a];
    const Pose body_a = of_a.body == RobotLink::world ? Pose{} : robot_.bodies[of_a.body].start;
    const Vec3 in_file = (body_a * of_a.in_body).point(tie.anchor);
    const Vec3 in_world = world().point(in_file);
    if (b.empty()) std::swap(a, b);
    made.a = a;
    made.b = b;
    made.anchor = in_world;
    if (!a.empty()) {
      const Placement& at = out_.scene.bodies.find(a)->placement;
      made.anchor = at.pose().inverse_point(in_world);
    }
    const std::string name = tie.name.empty() ? b + "_tie" : tie.name;
    out_.scene.joints.add(name_for(name, "joints.", tie.at), std::move(made));
  }

  /// Excludes collisions between two bodies by a joint that leaves all coordinates free, since
  /// jointed bodies do not collide.
  void apart(const std::string& a, const std::string& b, const RobotPlace& at) {
    if (a.empty() || b.empty() || !apart_.insert(std::minmax(a, b)).second) return;
    JointDescription made;
    made.kind = JointKind::free;
    made.a = a;
    made.b = b;
    out_.scene.joints.add(name_for(fmt::format("apart_{}", apart_.size()), "joints.", at),
                          std::move(made));
  }

  void keep_apart() {
    std::set<std::pair<std::string, std::string>> tied = apart_;
    for (const auto& item : out_.scene.joints.items)
      tied.insert(std::minmax(item.value.a, item.value.b));
    for (const auto& [i, k] : start_overlaps(robot_.bodies)) {
      const std::string &a = body_names_[i], &b = body_names_[k];
      if (a.empty() || b.empty() || tied.contains(std::minmax(a, b))) continue;
      log_.warn(robot_.bodies[k].at, fmt::format("'{}' overlaps '{}' at the start: they do not "
                                                 "collide with each other",
                                                 robot_.bodies[k].name, robot_.bodies[i].name));
      apart(a, b, robot_.bodies[k].at);
    }
  }

  const RobotOptions& o_;
  RobotLog& log_;
  RobotParts out_;
  RobotBodies robot_;
  std::vector<MassProperties> outboard_;
  std::vector<std::string> body_names_;          ///< "": the world
  std::vector<std::vector<JointStage>> stages_;  ///< by body
  RobotFollowers followers_;
  std::set<std::string> names_;
  std::set<std::pair<std::string, std::string>> apart_;
};

/// The name of the root element, from the first bytes of a file.
std::string root_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string text(4096, '\0');
  in.read(text.data(), std::streamsize(text.size()));
  text.resize(size_t(in.gcount()));
  for (size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1)) {
    if (text.compare(at, 4, "<!--") == 0) {
      at = text.find("-->", at);
      if (at == std::string::npos) break;
      continue;
    }
    if (at + 1 < text.size() && (text[at + 1] == '?' || text[at + 1] == '!')) continue;
    const size_t end = text.find_first_of(" \t\r\n/>", at);
    return text.substr(at + 1, end == std::string::npos ? end : end - at - 1);
  }
  return {};
}

}  // namespace

Pose z_up() {
  const double h = std::sqrt(0.5);
  return {Vec3::Zero(), Quat(h, -h, 0, 0)};
}

bool is_robot_file(const std::filesystem::path& file) {
  std::string name = file.filename().string();
  for (char& c : name)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  if (name.ends_with(".urdf") || name.ends_with(".urdf.gz") || name.ends_with(".mjcf")) return true;
  if (!name.ends_with(".xml")) return false;
  const std::string root = root_of(file);
  return root == "mujoco" || root == "robot";
}

RobotModel read_robot_file(const std::filesystem::path& file, const PackageFolders& packages,
                           RobotLog& log) {
  const auto root = read_xml(file, log);
  if (!root) return {};
  if (root->name == "robot") return read_urdf(*root, file, packages, log);
  if (root->name == "mujoco") return read_mjcf(*root, file, log);
  log.fault(root->at, fmt::format("the first element is <{}>; a robot file begins with <robot> "
                                  "(URDF) or <mujoco> (MJCF)",
                                  root->name));
  return {};
}

RobotParts make_robot(RobotModel model, const RobotOptions& options, RobotLog& log) {
  set_starts(model, options, log);
  return RobotMaker(options, log).take(model);
}

}  // namespace tumble
