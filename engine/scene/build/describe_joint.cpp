#include "engine/scene/build/describe_joint.hpp"

#include <numbers>

namespace tumble {
namespace {

constexpr double in_degrees = 180 / std::numbers::pi;

/// Sets the member of the bound's unit; an infinite bound is not given.
void describe_bound(double value, bool angle, std::optional<double>& length,
                    std::optional<double>& degrees) {
  if (!std::isfinite(value)) return;
  (angle ? degrees : length) = angle ? in_degrees * value : value;
}

MotorDescription describe_motor(const CoordinateMotor& motor, bool angle) {
  MotorDescription out;
  switch (motor.kind) {
    case MotorKind::velocity:
      out.velocity = motor.target;
      break;
    case MotorKind::position:
      (angle ? out.position_deg : out.position) = angle ? in_degrees * motor.target : motor.target;
      out.stiffness = motor.stiffness;
      if (motor.damping > 0) out.damping = motor.damping;
      break;
    case MotorKind::force:
      out.force = motor.target;
      break;
    case MotorKind::none:
      break;
  }
  if (motor.kind != MotorKind::force && std::isfinite(motor.max_force))
    out.max_force = motor.max_force;
  return out;
}

}  // namespace

DriveDescription describe_drive(const CoordinateDrive& drive, bool angle) {
  DriveDescription out;
  if (drive.limits.exist()) {
    LimitsDescription& limits = out.limits.emplace();
    describe_bound(drive.limits.lower, angle, limits.lower, limits.lower_deg);
    describe_bound(drive.limits.upper, angle, limits.upper, limits.upper_deg);
    limits.stiffness = drive.limits.stiffness;
    limits.damping = drive.limits.damping;
    limits.restitution = drive.limits.restitution;
  }
  if (drive.motor.kind != MotorKind::none) out.motor = describe_motor(drive.motor, angle);
  if (drive.spring.stiffness > 0 || drive.spring.damping > 0) {
    JointSpringDescription& spring = out.spring.emplace();
    spring.stiffness = drive.spring.stiffness;
    spring.damping = drive.spring.damping;
    if (drive.spring.rest != 0)
      describe_bound(drive.spring.rest, angle, spring.rest, spring.rest_deg);
  }
  out.friction = drive.friction;
  out.armature = drive.armature;
  return out;
}

}  // namespace tumble
