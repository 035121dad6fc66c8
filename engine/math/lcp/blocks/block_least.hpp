#pragma once
#include "engine/math/lcp/blocks/block_problem.hpp"

namespace tumble::lcp {

/// The least x with G x as near to `wanted` as can be (least squares in units in which rows of G
/// are about 1 long, the same for the rows of a group), by blocks of six: Tikhonov's
/// regularisation, iterated until it is gone from what rows are consistent (Riley, "Solving systems
/// of linear equations with a positive definite, symmetric, but possibly ill-conditioned matrix",
/// 1955). Directions in which G is shorter than about 1e-4 are partly left. Of the problem's
/// conditions only the groups are read.
std::vector<double> least_columns(const BlockProblem& problem, const VecX& wanted);

}  // namespace tumble::lcp
