#pragma once
#include "engine/dynamics/joints/articulation.hpp"
#include "engine/scene/build.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace tumble {

/// The joints of a scene as they stand now, with the bodies that they tie in the order in which
/// they name them: what an Articulation is made of.
struct JointedBodies {
  std::vector<RigidBody> bodies;
  std::vector<BodyId> ids;         ///< by body
  std::vector<uint32_t> block_of;  ///< by body
  std::vector<std::string> names;  ///< by joint
  std::vector<Joint> joints;
  std::vector<JointCoupling> couplings;

  explicit JointedBodies(const BuiltScene& built);
};

/// 0, 1, 2 ..
std::vector<uint32_t> first_numbers(size_t count);

}  // namespace tumble
