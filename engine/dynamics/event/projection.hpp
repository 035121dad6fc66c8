#pragma once
#include "engine/dynamics/joints/articulation.hpp"
#include "engine/dynamics/rows/rows.hpp"

#include <Eigen/Core>

namespace tumble {

/// The least change of velocities (in the metric of mass) by which every row's velocity changes by
/// `wanted`, as far as rows that depend on each other allow: least squares in the space of the
/// blocks (lcp::least_columns), or conjugate residuals where there are joints. Adds it to the
/// velocities of the blocks. The change is one that `joints` leave; they are to be held afterwards.
void change_least(std::span<const Row> rows, const Eigen::VectorXd& wanted,
                  std::span<DofBlock> blocks, const Articulation& joints = {});

}  // namespace tumble
