#pragma once
#include "engine/math/lcp/problem.hpp"

#include <array>
#include <vector>

namespace tumble::lcp {

/// A row of G: entries in at most two blocks of six columns.
struct BlockRow {
  std::array<int, 2> block{-1, -1};  ///< -1: none; the two differ
  std::array<std::array<double, 6>, 2> entries{};
};

/// A problem with A = G G^T and sparse rows of G; A is never formed. The three rows of a group have
/// the same blocks in the same order.
struct BlockProblem {
  int blocks = 0;
  std::vector<BlockRow> rows;
  LcpProblem conditions;  ///< everything but A, which is empty

  int size() const { return conditions.size(); }
};

/// Refuses what check() of problems refuses, rows with a block that does not exist or the same
/// block twice, and groups whose rows have different blocks.
Status check(const BlockProblem& problem);

/// Units of the unknowns (scaling_of()).
std::vector<double> row_units(const BlockProblem& problem);

/// The largest sum of the absolute terms of a row, |A| |z| + |b|, in those units; infinite when it
/// is not finite.
double largest_term(const BlockProblem& problem, const std::vector<double>& d, const VecX& z);

}  // namespace tumble::lcp
