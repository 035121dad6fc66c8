#pragma once
#include "engine/math/lcp/blocks/block_problem.hpp"

namespace tumble::lcp {

/// The x of least norm that minimises |G x - wanted|, in units in which rows of G have length about
/// 1 (the same for the rows of a group), by blocks of six: Tikhonov regularisation, iterated until
/// its effect vanishes from consistent rows (Riley, "Solving systems of linear equations with a
/// positive definite, symmetric, but possibly ill-conditioned matrix", 1955). Components along
/// directions in which G is smaller than about 1e-4 converge only partly. Of the problem's
/// conditions only the groups are used.
std::vector<double> least_columns(const BlockProblem& problem, const VecX& wanted);

}  // namespace tumble::lcp
