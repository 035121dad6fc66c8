#pragma once
#include "engine/dynamics/joints/articulation.hpp"

#include <span>

namespace tumble {

/// Force and torque of a joint on B, world axes; the torque is about B's anchor. The opposite acts
/// on A at the same point.
struct JointWrench {
  Vec3 force = Vec3::Zero();   ///< [N]
  Vec3 torque = Vec3::Zero();  ///< [N m]
};

/// The wrench of given forces by row; arm_b is from B's centre of mass to its anchor [m].
JointWrench joint_wrench(std::span<const JointRow> rows, std::span<const double> forces,
                         const Vec3& arm_b);

/// Adds the wrench of a force along a coordinate, at the bodies' present poses.
void add_coordinate_wrench(const Joint& joint, size_t coordinate, double force,
                           std::span<const RigidBody> bodies, JointWrench& out);

/// Mean wrench over the last tick, from its impulses along the rows at the given sides.
JointWrench mean_wrench(const Joint& joint, const JointSides& sides);

/// Root mean square distance of mass from the centre of its body, over these bodies: a typical
/// lever arm [m].
double typical_arm(std::span<const RigidBody> bodies, std::span<const uint32_t> slots);

/// If rows depend linearly on each other, different forces by row give the same pushes on bodies:
/// replaces the given forces by those with the least sum of squares, where a torque counts as a
/// force at the lever arm `arm` [m]. They are the limit of joints with equal, high stiffness, and
/// have every symmetry that the joints have. The pushes on bodies stay the same.
void take_least_forces(const Articulation& joints, std::span<const DofBlock> blocks, double arm,
                       std::span<double> forces);

}  // namespace tumble
