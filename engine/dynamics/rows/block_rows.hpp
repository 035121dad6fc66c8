#pragma once
#include "engine/dynamics/rows/rows.hpp"
#include "engine/math/lcp/blocks/block_problem.hpp"

#include <span>
#include <vector>

namespace tumble {

/// S with M^-1 = S S^T, of the blocks that rows need and something can move, numbered in order.
struct BlockRoots {
  std::vector<uint32_t> blocks;
  std::vector<double> mass;   ///< roots of the inverse masses
  std::vector<Mat3> inertia;  ///< lower triangles, roots of the inverse inertias

  BlockRoots(std::span<const Row> rows, std::span<const DofBlock> all);
  /// v += S x
  void add(std::span<const double> x, std::span<DofBlock> all) const;
};

/// Sets rows of `problem` to those of J S, whose products are those of the Delassus matrix.
void set_block_rows(std::span<const Row> rows, const BlockRoots& roots, lcp::BlockProblem& problem);

/// The problem with these conditions whose matrix is the Delassus matrix of the rows.
lcp::BlockProblem block_problem(std::span<const Row> rows, std::span<const DofBlock> all,
                                const lcp::LcpProblem& conditions);

}  // namespace tumble
