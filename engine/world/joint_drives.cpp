#include "engine/world/joint_drives.hpp"

#include <algorithm>

namespace tumble {

SmoothDrive smooth_force(const CoordinateDrive& d, double x, double v, double t) {
  SmoothDrive out;
  out.elastic = -d.spring.stiffness * (x - d.spring.rest);
  out.damping = -d.spring.damping * v;
  const CoordinateLimits& l = d.limits;
  if (!l.hard() && x < l.lower) {
    const double pull = l.stiffness * (l.lower - x);
    out.elastic += pull;
    out.damping += std::max(-l.damping * v, -pull);  // a limit only pushes
  }
  if (!l.hard() && x > l.upper) {
    const double pull = l.stiffness * (l.upper - x);
    out.elastic += pull;
    out.damping += std::min(-l.damping * v, -pull);
  }
  const CoordinateMotor& m = d.motor;
  if (m.kind == MotorKind::force) out.motor = m.target_at(t);
  if (m.kind == MotorKind::position)
    out.motor = m.stiffness * (m.target_at(t) - x) + m.damping * (m.target_rate - v);
  out.motor = std::clamp(out.motor, -m.max_force, m.max_force);
  return out;
}

ActingDrive acting_drive(const Joint& joint, size_t k, const JointSides& sides, double t) {
  const JointCoordinate& coordinate = entry_of(joint.kind).coordinates[k];
  ActingDrive out;
  out.row = coordinate.row(sides);
  out.rate = row_rate(out.row, sides);
  if (coordinate.turns)
    out.row.error =
        nearest_turn(out.row.error, joint.value[k] + 0.5 * t * (joint.rate[k] + out.rate));
  out.force = smooth_force((*joint.drives)[k], out.row.error, out.rate, t);
  return out;
}

void push_bodies(const JointRow& row, double force, const Joint& joint,
                 std::span<RigidBody> bodies) {
  const auto push = [&](uint32_t slot, const RowSide& side) {
    if (slot == no_body) return;
    bodies[slot].force += force * side.linear;
    bodies[slot].torque += force * side.angular;
  };
  push(joint.a, row.row.a);
  push(joint.b, row.row.b);
}

}  // namespace tumble
