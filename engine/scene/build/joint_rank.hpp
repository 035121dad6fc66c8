#pragma once
#include "engine/scene/build.hpp"

#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// How many of the equations that joints, motors of any strength and couplings ask for are
/// independent of each other as the bodies stand now.
struct JointRank {
  size_t rows = 0, rank = 0;
  /// Joints with rows that those before them hold too, and how many. Coupled ones are named by who
  /// follows.
  std::vector<std::pair<std::string, size_t>> dependent;
};

JointRank joint_rank(const BuiltScene& built);
/// "joint rows: 12, rank 9, dependent: 3 of 'lid'"; empty without joints. Of many joints the first
/// few are named.
std::string text_of(const JointRank& rank);

}  // namespace tumble
