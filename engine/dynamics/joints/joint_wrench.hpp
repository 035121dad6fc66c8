#pragma once
#include "engine/dynamics/joints/articulation.hpp"
#include "engine/math/block_ldl.hpp"

#include <span>
#include <vector>

namespace tumble {

/// The wrench of given forces by row; arm_b is from B's centre of mass to its anchor [m].
JointWrench joint_wrench(std::span<const JointRow> rows, std::span<const double> forces,
                         const Vec3& arm_b);

/// Adds the wrench of a force along a coordinate, at the bodies' present poses.
void add_coordinate_wrench(const Joint& joint, size_t coordinate, double force,
                           std::span<const RigidBody> bodies, JointWrench& out);

/// The wrench of the joint's stored forces (moving_force, relaxing_force) along its rows at the
/// given sides.
JointWrench wrench_of_rows(const Joint& joint, const JointSides& sides);

/// Root mean square distance of mass from the centre of its body, over these bodies: a typical
/// lever arm [m].
double typical_arm(std::span<const RigidBody> bodies, std::span<const uint32_t> slots);

/// If rows depend linearly on each other, different forces by row give the same pushes on bodies:
/// replaces the given forces by those with the least sum of squares, where a torque counts as a
/// force at the lever arm `arm` [m]. They are the limit of joints with equal, high stiffness, and
/// have every symmetry that the joints have. The pushes on bodies stay the same.
void take_least_forces(const Articulation& joints, std::span<const DofBlock> blocks, double arm,
                       std::span<double> forces);

/// The same, again and again for joints that tie the same blocks: keeps the layout of the equations
/// and its memory.
class LeastForces {
 public:
  /// Needs only the rows of the joints, by look(), and not whether any depend.
  void spread(const Articulation& joints, std::span<const DofBlock> blocks, double arm,
              std::span<double> forces);

 private:
  BlockLdl normal_;
  std::vector<double> given_, least_, left_;
};

}  // namespace tumble
