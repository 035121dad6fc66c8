#pragma once
#include "viewer/ui/comparison.hpp"

#include <string>

namespace tumble {

/// A difference between two worlds for display: "gravity: 0 -9.81 0 m/s² in A, 0 -5 0 m/s² in B".
std::string difference_text(const WorldDifference& difference);

}  // namespace tumble
