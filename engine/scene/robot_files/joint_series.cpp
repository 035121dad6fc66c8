#include "engine/scene/robot_files/joint_series.hpp"

#include "engine/scene/robot_files/tolerances.hpp"

#include <cmath>
#include <numbers>

namespace tumble {
namespace {

using JointType = RobotJoint::Kind;

bool at_right_angles(const Vec3& a, const Vec3& b) {
  return std::fabs(a.dot(b)) < robot_tolerances::same_direction;
}

bool along(const Vec3& a, const Vec3& b) {
  return a.dot(b) > 0 && a.cross(b).norm() < robot_tolerances::same_direction;
}

bool starts_at_zero(const RobotJoint& j) {
  return j.start == 0 && j.reference == 0;
}

bool is_idle(const RobotJoint& j) {
  return !j.lower && !j.upper && !j.actuator && !j.effort && !j.mimic && j.damping == 0 &&
         j.friction == 0 && j.armature == 0 && j.stiffness == 0;
}

/// The intersection of two perpendicular lines, if they intersect.
std::optional<Vec3> crossing(const RobotJoint& a, const RobotJoint& b) {
  const Vec3 apart = b.anchor - a.anchor, across = a.axis.cross(b.axis);
  if (std::fabs(apart.dot(across)) > robot_tolerances::same_place) return std::nullopt;
  return a.anchor + apart.dot(a.axis) * a.axis;
}

std::optional<JointStage> universal(const RobotJoint& a, const RobotJoint& b) {
  if (a.kind != JointType::hinge || b.kind != JointType::hinge || !at_right_angles(a.axis, b.axis))
    return std::nullopt;
  if (!starts_at_zero(a) || !starts_at_zero(b)) return std::nullopt;
  const auto point = crossing(a, b);
  if (!point) return std::nullopt;
  return JointStage{JointKind::universal, {}, *point, a.axis, b.axis, {"angle", "angle_2"}};
}

std::optional<JointStage> cylindrical(const RobotJoint& a, const RobotJoint& b) {
  const bool slide_first = a.kind == JointType::slide && b.kind == JointType::hinge;
  const bool hinge_first = a.kind == JointType::hinge && b.kind == JointType::slide;
  if ((!slide_first && !hinge_first) || !along(a.axis, b.axis)) return std::nullopt;
  if (!starts_at_zero(a) || !starts_at_zero(b)) return std::nullopt;
  JointStage out;
  out.kind = JointKind::cylindrical;
  out.anchor = slide_first ? b.anchor : a.anchor;
  out.axis = a.axis;
  out.names = slide_first ? std::vector<std::string>{"position", "angle"}
                          : std::vector<std::string>{"angle", "position"};
  return out;
}

std::optional<JointStage> planar(const RobotJoint& a, const RobotJoint& b, const RobotJoint& c) {
  if (a.kind != JointType::slide || b.kind != JointType::slide || c.kind != JointType::hinge)
    return std::nullopt;
  if (!at_right_angles(a.axis, b.axis) || !along(a.axis.cross(b.axis), c.axis) || !is_idle(a) ||
      !is_idle(b) || !starts_at_zero(a) || !starts_at_zero(b) || !starts_at_zero(c))
    return std::nullopt;
  return JointStage{JointKind::planar, {}, c.anchor, c.axis, {}, {"", "", "angle"}};
}

JointStage single(const RobotJoint& j) {
  const JointKind kind = j.kind == JointType::slide  ? JointKind::prismatic
                         : j.kind == JointType::ball ? JointKind::spherical
                                                     : JointKind::revolute;
  return {kind, {}, j.anchor, j.axis, {}, {""}};
}

constexpr double per_degree = std::numbers::pi / 180;

}  // namespace

std::vector<JointStage> joint_stages(std::span<const RobotJoint> joints) {
  std::vector<JointStage> out;
  for (size_t i = 0; i < joints.size();) {
    const size_t left = joints.size() - i;
    std::optional<JointStage> made;
    if (left >= 3) made = planar(joints[i], joints[i + 1], joints[i + 2]);
    if (!made && left >= 2) made = universal(joints[i], joints[i + 1]);
    if (!made && left >= 2) made = cylindrical(joints[i], joints[i + 1]);
    if (!made) made = single(joints[i]);
    for (size_t k = 0; k < made->names.size(); ++k) made->coordinates.push_back(i++);
    out.push_back(std::move(*made));
  }
  return out;
}

DriveDescription drive_of_joint(const RobotJoint& joint, const std::optional<HoldingGains>& hold) {
  DriveDescription out;
  const bool angle = joint.kind == JointType::hinge;
  const auto given = [angle](double value, auto& length, auto& degrees) {
    if (angle)
      degrees = value / per_degree;
    else
      length = value;
  };
  if (joint.lower || joint.upper) {
    LimitsDescription& limits = out.limits.emplace();
    if (joint.lower) given(*joint.lower, limits.lower, limits.lower_deg);
    if (joint.upper) given(*joint.upper, limits.upper, limits.upper_deg);
  }
  JointSpringDescription spring;
  spring.stiffness = joint.stiffness;
  spring.damping = joint.damping;
  if (joint.stiffness > 0) given(joint.rest, spring.rest, spring.rest_deg);
  out.friction = joint.friction;
  out.armature = joint.armature;
  const auto servo = [&](double target, double stiffness, double damping) {
    MotorDescription& motor = out.motor.emplace();
    given(target, motor.position, motor.position_deg);
    motor.stiffness = stiffness;
    motor.damping = damping;
  };
  if (joint.actuator && joint.actuator->kind == RobotActuator::Kind::damper) {
    spring.damping += joint.actuator->damping;
  } else if (joint.actuator && joint.actuator->kind == RobotActuator::Kind::force) {
    out.motor.emplace().force = joint.actuator->target;
  } else if (joint.actuator) {
    if (joint.actuator->stiffness > 0) {
      servo(joint.target.value_or(joint.actuator->target), joint.actuator->stiffness,
            joint.actuator->damping);
      out.motor->max_force = joint.actuator->max_force;
    }
  } else if (hold && hold->stiffness > 0) {
    servo(joint.target.value_or(joint.start), hold->stiffness, hold->damping);
    out.motor->max_force = joint.effort;
  }
  if (spring.stiffness > 0 || spring.damping > 0) out.spring = spring;
  return out;
}

}  // namespace tumble
