#include "engine/dynamics/contact/block_rows.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// The lower triangle L with L L^T = the given semi-definite matrix.
Mat3 cholesky_root(const Mat3& m) {
  Mat3 root = Mat3::Zero();
  for (int j = 0; j < 3; ++j)
    for (int i = j; i < 3; ++i) {
      double rest = m(i, j);
      for (int k = 0; k < j; ++k) rest -= root(i, k) * root(j, k);
      if (i == j)
        root(j, j) = std::sqrt(std::max(0.0, rest));
      else
        root(i, j) = root(j, j) > 0 ? rest / root(j, j) : 0;
    }
  return root;
}

}  // namespace

void set_block_rows(std::span<const Row> rows, std::span<const DofBlock> blocks,
                    lcp::BlockProblem& problem) {
  const auto moves = [&](uint32_t block) {
    return block != no_block && blocks[block].inverse_mass > 0;
  };
  std::vector<int> number(blocks.size(), -1);
  for (const Row& row : rows)
    for (const RowSide* side : {&row.a, &row.b})
      if (moves(side->block)) number[side->block] = 0;
  std::vector<double> root_of_mass;
  std::vector<Mat3> root_of_inertia;
  for (size_t i = 0; i < blocks.size(); ++i) {
    if (number[i] < 0) continue;
    number[i] = int(root_of_mass.size());
    root_of_mass.push_back(std::sqrt(blocks[i].inverse_mass));
    root_of_inertia.push_back(cholesky_root(blocks[i].inverse_inertia));
  }
  problem.blocks = int(root_of_mass.size());
  problem.rows.assign(rows.size(), {});
  for (size_t i = 0; i < rows.size(); ++i) {
    size_t s = 0;
    for (const RowSide* side : {&rows[i].a, &rows[i].b}) {
      if (!moves(side->block)) continue;
      const int block = number[side->block];
      const Mat3& root = root_of_inertia[size_t(block)];
      std::array<double, 6>& entries = problem.rows[i].entries[s];
      for (int k = 0; k < 3; ++k) {
        entries[size_t(k)] = root_of_mass[size_t(block)] * side->linear[k];
        for (int j = k; j < 3; ++j) entries[size_t(k) + 3] += root(j, k) * side->angular[j];
      }
      problem.rows[i].block[s++] = block;
    }
  }
}

}  // namespace tumble
