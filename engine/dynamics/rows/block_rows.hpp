#pragma once
#include "engine/dynamics/rows/rows.hpp"
#include "engine/math/lcp/blocks/block_problem.hpp"

#include <span>
#include <vector>

namespace tumble {

/// S with M^-1 = S S^T, for the movable blocks that occur in rows, numbered in ascending order.
struct BlockRoots {
  std::vector<uint32_t> blocks;
  std::vector<double> mass;   ///< square roots of the inverse masses
  std::vector<Mat3> inertia;  ///< lower triangular Cholesky factors of the inverse inertias

  BlockRoots(std::span<const Row> rows, std::span<const DofBlock> all);
  /// v += S x
  void add(std::span<const double> x, std::span<DofBlock> all) const;
};

/// Sets the rows of `problem` to those of J S, whose inner products are the entries of the Delassus
/// matrix.
void set_block_rows(std::span<const Row> rows, const BlockRoots& roots, lcp::BlockProblem& problem);

/// A block problem with these conditions, whose matrix is the Delassus matrix of the rows.
lcp::BlockProblem block_problem(std::span<const Row> rows, std::span<const DofBlock> all,
                                const lcp::LcpProblem& conditions);

}  // namespace tumble
