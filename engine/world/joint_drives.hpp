#pragma once
#include "engine/dynamics/joints/joint.hpp"

namespace tumble {

/// The forces along a coordinate that its value and rate give at any moment: springs, dampers,
/// limits that give way, motors of force and of position.
struct SmoothDrive {
  double elastic = 0, damping = 0, motor = 0;  ///< [N] or [N m]
  double total() const { return elastic + damping + motor; }
};
/// `t` seconds after the tick began.
SmoothDrive smooth_force(const CoordinateDrive& drive, double value, double rate, double t);

/// A driven coordinate now.
struct ActingDrive {
  JointRow row;
  double rate = 0;
  SmoothDrive force;
};
/// `t` seconds after the joint's value was known.
ActingDrive acting_drive(const Joint& joint, size_t coordinate, const JointSides& sides, double t);

/// Calls f(coordinate, ActingDrive) for all that acts along a joint's coordinates.
template <class F>
void for_drives(const Joint& joint, std::span<const RigidBody> bodies, double t, const F& f) {
  if (!joint.drives) return;
  const JointSides sides = joint_sides(joint, bodies);
  for (size_t k = 0; k < most_coordinates; ++k)
    if (joint.driven(k)) f(k, acting_drive(joint, k, sides, t));
}

/// Adds a force along a row to the sums of the joint's bodies.
void push_bodies(const JointRow& row, double force, const Joint& joint,
                 std::span<RigidBody> bodies);

}  // namespace tumble
