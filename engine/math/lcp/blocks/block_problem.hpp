#pragma once
#include "engine/math/lcp/problem.hpp"

#include <array>
#include <vector>

namespace tumble::lcp {

/// A row of G: entries in at most two blocks of six columns.
struct BlockRow {
  std::array<int, 2> block{-1, -1};  ///< -1: none; never the same twice
  std::array<std::array<double, 6>, 2> entries{};
};

/// A problem whose A is G G^T with sparse rows: A is never formed. The three rows of a group name
/// the same blocks in the same order.
struct BlockProblem {
  int blocks = 0;
  std::vector<BlockRow> rows;
  LcpProblem conditions;  ///< all but A, which is empty

  int size() const { return conditions.size(); }
};

/// Refuses what check() of problems refuses, rows that name blocks that do not exist or one twice,
/// and groups whose rows name different blocks.
Status check(const BlockProblem& problem);

/// Units of the unknowns (scaling_of()).
std::vector<double> row_units(const BlockProblem& problem);

/// The largest sum of the terms of a row of |A| |z| + |b|, in those units; infinite when it is not
/// finite.
double largest_term(const BlockProblem& problem, const std::vector<double>& d, const VecX& z);

}  // namespace tumble::lcp
