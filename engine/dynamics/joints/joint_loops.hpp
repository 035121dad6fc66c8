#pragma once
#include "engine/dynamics/joints/joint_wrench.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// Joints that close loops with each other, through bodies or through what cannot move: a door on
/// two hinges, a table on parallel links. Only there can rows depend on each other, so that the
/// motion does not determine how a load is divided among them.
struct JointLoops {
  std::vector<uint32_t> bodies;  ///< slots, ascending: those that these joints move
  std::vector<uint32_t> joints;  ///< slots, ascending
  Articulation rows;             ///< of the joints; block i is bodies[i]
  // Memory of share_impulses().
  LeastForces least;
  std::vector<DofBlock> blocks;
  std::vector<double> given, change;  ///< by row
  std::vector<Vec3> arms;             ///< by joint
};

/// The loops among the joints `which`, separate where no body connects them, except those of more
/// than `tolerances::most_shared_rows` rows.
std::vector<JointLoops> find_loops(std::span<const Joint> joints, std::span<const uint32_t> which,
                                   std::span<const RigidBody> bodies);

/// Divides the impulses of these joints over the last tick (Joint::impulse) as take_least_forces
/// does for forces, at the present poses: for steppers that solve joints one after the other, where
/// the first one takes what several could. What acts along coordinates stays where it is. No body
/// moves differently.
void share_impulses(JointLoops& loops, std::span<const RigidBody> bodies, std::span<Joint> joints);

}  // namespace tumble
