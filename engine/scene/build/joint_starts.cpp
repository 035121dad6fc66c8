#include "engine/scene/build/joint_starts.hpp"

#include "engine/scene/build/sentences.hpp"
#include "engine/world/world.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

namespace tumble {
namespace {

/// Errors attributed to rounding of the scene's numbers: relative [-], and absolute [m, rad].
constexpr double value_slack = 1e-4, least_value = 1e-6;
/// The same for velocities [-] and [m/s, rad/s].
constexpr double speed_slack = 1e-3, least_speed = 1e-3;

struct StartingJoint {
  std::string name;
  const JointDef* def = nullptr;
  const JointFrame* now = nullptr;
  JointSides sides;
  /// Whether the initial velocities of all bodies are known; those of bodies on courses are not.
  bool velocity_known = true;

  const JointCoordinate& kind_of(size_t k) const { return entry_of(def->kind).coordinates[k]; }
  std::string place(size_t k) const {
    return entry_of(def->kind).coordinates.size() == 1
               ? fmt::format("joints.{}", name)
               : fmt::format("joints.{}.{}", name, kind_of(k).name);
  }
  double value(size_t k) const { return now->coordinates[k].value; }
  double rate(size_t k) const { return row_rate(kind_of(k).row(sides), sides); }
};

std::string value_with_unit(double value, bool angle) {
  // Residues of rounding are shown as zero.
  const double shown = std::fabs(value) < least_value ? 0 : value;
  return angle ? fmt::format("{:.6g} deg", shown * 180 / std::numbers::pi)
               : fmt::format("{:.6g} m", shown);
}
std::string rate_with_unit(double rate, bool angle) {
  return fmt::format("{:.6g} {}", rate, angle ? "rad/s" : "m/s");
}

JointSide side_of(const Pose& frame, const RigidBody* body) {
  return joint_side({body ? Vec3(frame.x - body->centre_body) : frame.x, frame.q.normalized()},
                    body);
}

std::map<uint32_t, StartingJoint> starting_joints(const BuiltScene& built, const Frame& frame) {
  std::map<uint32_t, StartingJoint> out;
  for (const auto& [name, id] : built.joints) {
    const JointDef* def = built.world->joint(id);
    const auto now = std::ranges::find(*frame.joints, id, &JointFrame::id);
    if (!def || now == frame.joints->end()) continue;
    StartingJoint& joint = out[id.index];
    joint.name = name, joint.def = def, joint.now = &*now;
    const RigidBody *a = built.world->body(def->a), *b = built.world->body(def->b);
    joint.sides = {side_of(def->frame_a, a), side_of(def->frame_b, b), def->length};
    for (const RigidBody* body : {a, b})
      if (body && body->type == BodyType::kinematic) joint.velocity_known = false;
  }
  return out;
}

/// How the run treats an inconsistent position.
std::string taken_back(const WorldSettings& settings, bool angle) {
  if (settings.stepper != "event") return "the run takes that back in its first ticks";
  return fmt::format("the run takes that back at {} (event.recovery_speed)",
                     rate_with_unit(settings.event.recovery_speed, angle));
}

/// Sums of squares over the rows of a joint's parts, of lengths and of angles.
struct Off {
  double apart = 0, turned = 0;

  template <class Value>
  Off(const StartingJoint& joint, const Value& value) {
    JointRows rows;
    joint_rows(joint.def->kind, joint.sides, rows);
    for (const JointRow& row : rows.all()) {
      double& sum = row.row.b.linear.isZero(0) ? turned : apart;
      sum = std::hypot(sum, value(row));
    }
  }
};

/// Reports ends that are not where the joint must hold them; for rods, a wrong length.
void look_at_ends(const StartingJoint& joint, const WorldSettings& settings, Sentences& sentences) {
  if (joint.def->kind == JointKind::distance) return;
  const Off off(joint, [](const JointRow& row) { return row.error; });
  const JointSide &a = joint.sides.a, &b = joint.sides.b;
  const double size = a.arm.norm() + b.arm.norm() + (a.anchor() - b.anchor()).norm();
  const auto add = [&](double by, double least, bool angle) {
    if (by > least)
      sentences.add(
          fmt::format("joints.{}: its ends begin {} off; {} (place the bodies to fit, or "
                      "set \"assemble\": true)",
                      joint.name, value_with_unit(by, angle), taken_back(settings, angle)));
  };
  add(off.apart, least_value + value_slack * size, false);
  add(off.turned, least_value + value_slack, true);
}

void look_at_limits(const StartingJoint& joint, const WorldSettings& settings,
                    Sentences& sentences) {
  for (size_t k = 0; k < entry_of(joint.def->kind).coordinates.size(); ++k) {
    const CoordinateLimits& l = joint.def->drives[k].limits;
    const bool angle = joint.kind_of(k).angle, below = joint.value(k) < l.lower;
    const double limit = below ? l.lower : l.upper;
    const double beyond = below ? l.lower - joint.value(k) : joint.value(k) - l.upper;
    if (!(beyond > least_value + value_slack * std::fabs(limit))) continue;
    sentences.add(fmt::format(
        "{}: begins at {}, {} beyond its {} limit of {}; {} (let it begin "
        "within its limits, or set \"assemble\": true)",
        joint.place(k), value_with_unit(joint.value(k), angle), value_with_unit(beyond, angle),
        below ? "lower" : "upper", value_with_unit(limit, angle),
        l.hard() ? taken_back(settings, angle)
                 : std::string("the limit's stiffness pushes it back")));
  }
}

void look_at_coupling(const StartingJoint& joint, size_t k, const StartingJoint& leader,
                      const CoordinateCouple& couple, const WorldSettings& settings,
                      Sentences& sentences) {
  const bool angle = joint.kind_of(k).angle;
  const double led = leader.value(couple.coordinate);
  const double asked = couple.ratio * led + couple.offset, is = joint.value(k);
  if (std::fabs(is - asked) > least_value + value_slack * (std::fabs(is) + std::fabs(asked)))
    sentences.add(fmt::format(
        "{}: begins at {}, but '{}', which it is coupled to, begins at {} and asks for {}: {} off; "
        "{} (choose offset, ratio and where the two begin to fit, or set \"assemble\": true)",
        joint.place(k), value_with_unit(is, angle), leader.name,
        value_with_unit(led, leader.kind_of(couple.coordinate).angle),
        value_with_unit(asked, angle), value_with_unit(std::fabs(is - asked), angle),
        taken_back(settings, angle)));
  if (!joint.velocity_known || !leader.velocity_known) return;
  const double rate = joint.rate(k), ahead = couple.ratio * leader.rate(couple.coordinate);
  if (std::fabs(rate - ahead) > least_speed + speed_slack * (std::fabs(rate) + std::fabs(ahead)))
    sentences.add(fmt::format(
        "{}: begins at {}, but '{}', which it is coupled to, asks for {}; an "
        "impulse in the first tick makes them agree (give the bodies "
        "velocities that fit, or set \"assemble\": true)",
        joint.place(k), rate_with_unit(rate, angle), leader.name, rate_with_unit(ahead, angle)));
}

/// Reports initial velocities with which parts held by a joint would separate.
void look_at_velocities(const StartingJoint& joint, Sentences& sentences) {
  if (!joint.velocity_known) return;
  const Off off_by(joint, [&](const JointRow& row) { return row_rate(row, joint.sides); });
  const JointSide &a = joint.sides.a, &b = joint.sides.b;
  const double speed = a.anchor_velocity().norm() + b.anchor_velocity().norm();
  const double spin = a.omega.norm() + b.omega.norm();
  const auto add = [&](double off, double size, bool angle) {
    if (off > least_speed + speed_slack * size)
      sentences.add(fmt::format(
          "joints.{}: its bodies begin with velocities that it does not allow: {} against each "
          "other; an impulse in the first tick ends that (give them velocities that fit, or set "
          "\"assemble\": true)",
          joint.name, rate_with_unit(off, angle)));
  };
  add(off_by.apart, speed, false);
  add(off_by.turned, spin, true);
}

}  // namespace

std::vector<std::string> joint_start_warnings(const BuiltScene& built) {
  std::vector<std::string> out;
  if (built.joints.empty()) return out;
  const auto frame = built.world->frame();
  if (!frame->joints) return out;
  const WorldSettings& settings = built.world->settings();
  const std::map<uint32_t, StartingJoint> joints = starting_joints(built, *frame);
  {
    Sentences sentences(out);
    for (const auto& [index, joint] : joints) look_at_ends(joint, settings, sentences);
  }
  {
    Sentences sentences(out);
    for (const auto& [index, joint] : joints) look_at_limits(joint, settings, sentences);
  }
  {
    Sentences sentences(out);
    for (const auto& [index, joint] : joints)
      for (size_t k = 0; k < most_coordinates; ++k) {
        const auto& couple = joint.def->drives[k].couple;
        if (!couple) continue;
        const auto leader = joints.find(couple->joint.is_null() ? index : couple->joint.index);
        if (leader != joints.end())
          look_at_coupling(joint, k, leader->second, *couple, settings, sentences);
      }
  }
  {
    Sentences sentences(out);
    for (const auto& [index, joint] : joints) look_at_velocities(joint, sentences);
  }
  return out;
}

}  // namespace tumble
