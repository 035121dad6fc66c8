#pragma once
#include "engine/dynamics/joints/articulation.hpp"

#include <span>

namespace tumble {

/// Force and torque of a joint on B, world axes; the torque is about B's anchor. A feels the
/// reverse at the same point.
struct JointWrench {
  Vec3 force = Vec3::Zero();   ///< [N]
  Vec3 torque = Vec3::Zero();  ///< [N m]
};

/// The wrench of forces by row; the arm is from B's centre of mass to its anchor [m].
JointWrench joint_wrench(std::span<const JointRow> rows, std::span<const double> forces,
                         const Vec3& arm_b);

/// Adds that of a force along a coordinate, the bodies being where they are.
void add_coordinate_wrench(const Joint& joint, size_t coordinate, double force,
                           std::span<const RigidBody> bodies, JointWrench& out);

/// Mean over the last tick, by its impulses along the rows of the given sides.
JointWrench mean_wrench(const Joint& joint, const JointSides& sides);

/// Root mean square of the distance of mass from the centre of its body: what a torque's arm is
/// like among these [m].
double typical_arm(std::span<const RigidBody> bodies, std::span<const uint32_t> slots);

/// Where rows depend on each other many forces by row push the bodies alike: replaces the given
/// ones by those of the least sum of squares, a torque counted as the force that makes it at the
/// arm [m]. These are the limit of joints that yield a little, all with the same stiffness: they
/// keep every symmetry that joints have. Bodies are pushed as before.
void take_least_forces(const Articulation& joints, std::span<const DofBlock> blocks, double arm,
                       std::span<double> forces);

}  // namespace tumble
