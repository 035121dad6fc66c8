#pragma once
#include "engine/dynamics/joints/joint.hpp"

namespace tumble {

/// The forces along a coordinate of a joint that are functions of its value and rate at the moment:
/// springs, dampers, compliant limits, motors of force and of position.
struct SmoothDrive {
  double elastic = 0, damping = 0, motor = 0;  ///< [N] or [N m]
  double total() const { return elastic + damping + motor; }
};
/// At `t` seconds after the start of the tick.
SmoothDrive smooth_force(const CoordinateDrive& drive, double value, double rate, double t);

/// A driven coordinate at a moment: its row, its rate, and its force.
struct ActingDrive {
  JointRow row;
  double rate = 0;
  SmoothDrive force;
};
/// At `t` seconds after the moment at which the joint's stored value was current.
ActingDrive acting_drive(const Joint& joint, size_t coordinate, const JointSides& sides, double t);

/// Calls f(coordinate, ActingDrive) for every driven coordinate of a joint.
template <class F>
void for_drives(const Joint& joint, std::span<const RigidBody> bodies, double t, const F& f) {
  if (!joint.drives) return;
  const JointSides sides = joint_sides(joint, bodies);
  for (size_t k = 0; k < most_coordinates; ++k)
    if (joint.driven(k)) f(k, acting_drive(joint, k, sides, t));
}

/// Adds a force along a row to the force sums of the joint's bodies.
void push_bodies(const JointRow& row, double force, const Joint& joint,
                 std::span<RigidBody> bodies);

}  // namespace tumble
