#pragma once
#include "engine/dynamics/joints/articulation.hpp"
#include "engine/dynamics/rows/rows.hpp"

#include <Eigen/Core>

namespace tumble {

/// The least change of velocities, in the norm of kinetic energy, by which the velocity of each row
/// changes by `wanted`, as far as dependent rows allow: a least-squares problem over the blocks
/// (lcp::least_columns), or conjugate residuals where there are joints. Adds the change to the
/// velocities of the blocks. The change is compatible with `joints`, which the caller must hold
/// afterwards.
void change_least(std::span<const Row> rows, const Eigen::VectorXd& wanted,
                  std::span<DofBlock> blocks, const Articulation& joints = {});

}  // namespace tumble
