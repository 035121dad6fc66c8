#include "engine/dynamics/rows/block_rows.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// The lower triangle L with L L^T = m, for a semi-definite matrix m.
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

BlockRoots::BlockRoots(std::span<const Row> rows, std::span<const DofBlock> all) {
  std::vector<char> used(all.size(), 0);
  for (const Row& row : rows)
    for (const RowSide* side : {&row.a, &row.b})
      if (side->block != no_block && all[side->block].inverse_mass > 0) used[side->block] = 1;
  for (uint32_t i = 0; i < all.size(); ++i) {
    if (!used[i]) continue;
    blocks.push_back(i);
    mass.push_back(std::sqrt(all[i].inverse_mass));
    inertia.push_back(cholesky_root(all[i].inverse_inertia));
  }
}

void BlockRoots::add(std::span<const double> x, std::span<DofBlock> all) const {
  for (size_t i = 0; i < blocks.size(); ++i) {
    DofBlock& block = all[blocks[i]];
    for (int k = 0; k < 3; ++k) {
      block.v[k] += mass[i] * x[6 * i + size_t(k)];
      for (int j = 0; j <= k; ++j) block.omega[k] += inertia[i](k, j) * x[6 * i + 3 + size_t(j)];
    }
  }
}

void set_block_rows(std::span<const Row> rows, const BlockRoots& roots,
                    lcp::BlockProblem& problem) {
  std::vector<int> number(roots.blocks.empty() ? 0 : roots.blocks.back() + 1, -1);
  for (size_t i = 0; i < roots.blocks.size(); ++i) number[roots.blocks[i]] = int(i);
  problem.blocks = int(roots.blocks.size());
  problem.rows.assign(rows.size(), {});
  for (size_t i = 0; i < rows.size(); ++i) {
    size_t s = 0;
    for (const RowSide* side : {&rows[i].a, &rows[i].b}) {
      if (side->block >= number.size() || number[side->block] < 0) continue;
      const auto block = size_t(number[side->block]);
      std::array<double, 6>& entries = problem.rows[i].entries[s];
      for (int k = 0; k < 3; ++k) {
        entries[size_t(k)] = roots.mass[block] * side->linear[k];
        for (int j = k; j < 3; ++j)
          entries[size_t(k) + 3] += roots.inertia[block](j, k) * side->angular[j];
      }
      problem.rows[i].block[s++] = int(block);
    }
  }
}

lcp::BlockProblem block_problem(std::span<const Row> rows, std::span<const DofBlock> all,
                                const lcp::LcpProblem& conditions) {
  lcp::BlockProblem out;
  out.conditions = conditions;
  set_block_rows(rows, BlockRoots(rows, all), out);
  return out;
}

}  // namespace tumble
