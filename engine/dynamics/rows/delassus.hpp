#pragma once
#include "engine/dynamics/rows/rows.hpp"

#include <Eigen/Core>

namespace tumble {

/// M^-1 J^T of a row: how an impulse along it moves both its sides.
Row response(const Row& row, std::span<const DofBlock> blocks);
/// How fast a row goes by that, an entry of J M^-1 J^T.
double coupling(const Row& row, const Row& response);

/// The Delassus matrix J M^-1 J^T of a list of rows: symmetric, positive semi-definite. Zero where
/// a stop was requested.
Eigen::MatrixXd delassus(std::span<const Row> rows, std::span<const DofBlock> blocks);

}  // namespace tumble
