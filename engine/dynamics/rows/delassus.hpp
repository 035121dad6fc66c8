#pragma once
#include "engine/dynamics/rows/rows.hpp"

#include <Eigen/Core>

namespace tumble {

/// M^-1 J^T of a row: change of the velocities of its two blocks by a unit impulse.
Row response(const Row& row, std::span<const DofBlock> blocks);
/// An entry of J M^-1 J^T: velocity along a row by the response of another one.
double coupling(const Row& row, const Row& response);

/// The Delassus matrix J M^-1 J^T of a list of rows: symmetric, positive semi-definite. Zero if a
/// stop was requested.
Eigen::MatrixXd delassus(std::span<const Row> rows, std::span<const DofBlock> blocks);

}  // namespace tumble
