#pragma once
#include "engine/dynamics/contact/rows.hpp"
#include "engine/math/lcp/block_problem.hpp"

#include <span>
#include <vector>

namespace tumble {

/// Sets rows of `problem` to those of J S with M^-1 = S S^T, whose products are those of the
/// Delassus matrix. Blocks that no row needs or nothing moves are left out and the others numbered
/// in order.
void set_block_rows(std::span<const Row> rows, std::span<const DofBlock> blocks,
                    lcp::BlockProblem& problem);

}  // namespace tumble
