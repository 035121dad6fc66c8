#pragma once
#include "engine/dynamics/rows/rows.hpp"

#include <Eigen/Core>

namespace tumble {

/// The Delassus matrix J M^-1 J^T of a list of rows: symmetric, positive semi-definite. Zero where
/// a stop was requested.
Eigen::MatrixXd delassus(std::span<const Row> rows, std::span<const DofBlock> blocks);

}  // namespace tumble
