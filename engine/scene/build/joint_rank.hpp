#pragma once
#include "engine/scene/build.hpp"

#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// Rank of the equations of joints, motors of unlimited strength and couplings, at the present
/// poses of the bodies.
struct JointRank {
  size_t rows = 0, rank = 0;
  /// Joints with rows that depend on those of previous joints, and the number of these rows.
  /// Couplings are named by the joint that follows.
  std::vector<std::pair<std::string, size_t>> dependent;
};

JointRank joint_rank(const BuiltScene& built);
/// "joint rows: 12, rank 9, dependent: 3 of 'lid'"; empty without joints. Lists only the first few
/// joints.
std::string text_of(const JointRank& rank);

}  // namespace tumble
